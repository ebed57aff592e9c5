#include "octree/builder/tree/page_plan.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "octree/builder/tree/area_split.h"
#include "octree/builder/tree/treelets.h"
#include "octree/geometry/octcode.h"

namespace planetree::octree {
namespace {

struct Key {
  std::uint64_t octcode = 0;
  std::uint32_t ordinal = 0;
  auto operator<=>(const Key&) const = default;  // NOLINT(modernize-use-nullptr)
};

// A page that has no number yet.
struct Draft {
  PlannedPage page;
  std::uint32_t slots = 0;
};

class PagePlanner {
 public:
  PagePlanner(const WideTree& tree, const std::vector<MortonKey>& keys, const RecordSlots& slots,
              std::uint32_t page_bytes)
      : tree_(tree),
        keys_(keys),
        slots_(slots),
        links_(page_bytes),
        head_slots_(frame_head_slots(page_bytes)),
        capacity_(static_cast<std::uint32_t>(page_bytes / kSlotBytes) - head_slots_),
        cut_(cut_treelets(tree, slots, bottom_slots(page_bytes), capacity_)) {
    plan_.page_bytes = page_bytes;
  }

  Result<PagePlan> plan() {
    set_treelet_slots();
    drafts_.emplace_back();
    const RecordRef root{tree_.nodes.empty(), 0};
    std::vector<RecordRef> below;
    put(drafts_[0], root);
    for (std::size_t i = 0; i < drafts_.size(); ++i) {
      below.clear();
      fill(drafts_[i].page, below);
      pack(below);
    }
    if (drafts_.size() > links_.max_pages())
      return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                        "%zu pages, more than links can address; build with a larger page size",
                        drafts_.size());
    number_pages();
    return std::move(plan_);
  }

 private:
  // A quarter page, but enough for one record of any kind.
  static std::uint32_t bottom_slots(std::uint32_t page_bytes) {
    return std::max<std::uint32_t>(page_bytes / 4, 2048) / kSlotBytes;
  }

  void set_treelet_slots() {
    node_slots_.resize(tree_.nodes.size());
    for (const Treelet& treelet : cut_.treelets)
      if (!treelet.root.block) node_slots_[treelet.root.index] = treelet.slots;
  }

  std::uint32_t treelet_slots(RecordRef root) const {
    return root.block ? slots_.blocks[root.index] : node_slots_[root.index];
  }

  void put(Draft& draft, RecordRef root) {
    draft.slots += treelet_slots(root);
    if (root.block) {
      draft.page.blocks.push_back(root.index);
      ++draft.page.root_block_count;
    } else {
      draft.page.nodes.push_back(root.index);
      ++draft.page.root_node_count;
    }
  }

  // Completes a page from its roots, breadth first. Collects, in order, the roots of the treelets
  // that hang from it.
  void fill(PlannedPage& page, std::vector<RecordRef>& below) const {
    for (std::size_t i = 0; i < page.nodes.size(); ++i) {
      const WideNode& node = tree_.nodes[page.nodes[i]];
      for (unsigned c = 0; c < node.child_count; ++c) {
        const WideChild& child = node.children[c];
        const bool apart = child.block ? cut_.cut_blocks[child.index] : cut_.cut_nodes[child.index];
        if (apart)
          below.push_back({child.block, child.index});
        else if (child.block)
          page.blocks.push_back(child.index);
        else
          page.nodes.push_back(child.index);
      }
    }
  }

  // Fills new pages with treelets in Morton order.
  void pack(std::vector<RecordRef>& roots) {
    std::stable_sort(roots.begin(), roots.end(), [&](RecordRef a, RecordRef b) {
      return range_of(a).first < range_of(b).first;
    });
    bool open = false;
    for (const RecordRef root : roots) {
      if (!open || drafts_.back().slots + treelet_slots(root) > capacity_) {
        drafts_.emplace_back();
        open = true;
      }
      put(drafts_.back(), root);
    }
  }

  std::pair<std::uint32_t, std::uint32_t> range_of(RecordRef record) const {
    if (record.block) return {tree_.blocks[record.index].begin, tree_.blocks[record.index].end};
    const WideNode& node = tree_.nodes[record.index];
    return {node.children[0].begin, node.children[node.child_count - 1u].end};
  }

  // Octcode of the smallest cell that holds the box centres of a record's triangles.
  std::uint64_t octcode_of(RecordRef record) const {
    const auto [begin, end] = range_of(record);
    std::uint64_t least = keys_[begin].code, greatest = least;
    // Keys are not sorted within an area split, and are sorted above it.
    const std::uint32_t last = std::min(end, begin + kMaxAreaSplit);
    for (std::uint32_t i = begin; i < last; ++i) {
      least = std::min(least, keys_[i].code);
      greatest = std::max(greatest, keys_[i].code);
    }
    for (std::uint32_t i = end - (last - begin); i < end; ++i) {
      least = std::min(least, keys_[i].code);
      greatest = std::max(greatest, keys_[i].code);
    }
    return octcode_of_range(least, greatest);
  }

  // Numbers the roots of treelets in preorder: parents come first, so that ordinals ascend
  // downward.
  void give_keys() {
    std::map<std::uint64_t, std::uint32_t> next_ordinal;
    std::vector<RecordRef> roots;
    for (const Treelet& treelet : cut_.treelets) roots.push_back(treelet.root);
    std::stable_sort(roots.begin(), roots.end(), [&](RecordRef a, RecordRef b) {
      const auto [a_begin, a_end] = range_of(a);
      const auto [b_begin, b_end] = range_of(b);
      if (a_begin != b_begin) return a_begin < b_begin;
      if (a_end != b_end) return a_end > b_end;
      return !a.block && b.block;
    });
    node_keys_.resize(tree_.nodes.size());
    block_keys_.resize(tree_.blocks.size());
    for (const RecordRef root : roots) {
      const std::uint64_t octcode = octcode_of(root);
      (root.block ? block_keys_ : node_keys_)[root.index] = {octcode, next_ordinal[octcode]++};
    }
  }

  Key key_of(const PlannedPage& page) const {
    Key key{~std::uint64_t{0}, ~std::uint32_t{0}};
    for (std::size_t i = 0; i < page.root_node_count; ++i)
      key = std::min(key, node_keys_[page.nodes[i]]);
    for (std::size_t i = 0; i < page.root_block_count; ++i)
      key = std::min(key, block_keys_[page.blocks[i]]);
    return key;
  }

  void number_pages() {
    give_keys();
    for (Draft& draft : drafts_) {
      const Key key = key_of(draft.page);
      draft.page.octcode = key.octcode;
      draft.page.ordinal = key.ordinal;
      plan_.pages.push_back(std::move(draft.page));
    }
    std::sort(plan_.pages.begin(), plan_.pages.end(),
              [](const PlannedPage& a, const PlannedPage& b) {
                return Key{a.octcode, a.ordinal} < Key{b.octcode, b.ordinal};
              });
    plan_.node_links.resize(tree_.nodes.size());
    plan_.block_links.resize(tree_.blocks.size());
    for (std::uint32_t number = 0; number < plan_.pages.size(); ++number) link_page(number);
  }

  void link_page(std::uint32_t number) {
    PlannedPage& page = plan_.pages[number];
    page.number = number;
    std::uint32_t slot = head_slots_;
    for (const std::uint32_t node : page.nodes) {
      plan_.node_links[node] = links_.make(false, number, slot);
      slot += slots_.node;
    }
    for (const std::uint32_t block : page.blocks) {
      plan_.block_links[block] = links_.make(true, number, slot);
      slot += slots_.blocks[block];
    }
  }

  const WideTree& tree_;
  const std::vector<MortonKey>& keys_;
  RecordSlots slots_;
  LinkFormat links_;
  std::uint32_t head_slots_;
  std::uint32_t capacity_;
  TreeletCut cut_;
  std::vector<std::uint32_t> node_slots_;
  std::vector<Key> node_keys_, block_keys_;
  std::vector<Draft> drafts_;
  PagePlan plan_;
};

}  // namespace

Result<PagePlan> plan_pages(const WideTree& tree, const std::vector<MortonKey>& keys,
                            const RecordSlots& slots, std::uint32_t page_bytes) {
  return PagePlanner(tree, keys, slots, page_bytes).plan();
}

}  // namespace planetree::octree
