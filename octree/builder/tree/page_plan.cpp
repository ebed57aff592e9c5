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

// Octcode of the smallest cell that holds the box centres of the triangles keys[begin ... end) of a
// node or a block.
std::uint64_t octcode_of(const std::vector<MortonKey>& keys, std::uint32_t begin,
                         std::uint32_t end) {
  std::uint64_t least = keys[begin].code, greatest = least;
  // Keys are not sorted within an area split, and are sorted above it.
  const std::uint32_t last = std::min(end, begin + kMaxAreaSplit);
  const auto add = [&](std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t i = from; i < to; ++i) {
      least = std::min(least, keys[i].code);
      greatest = std::max(greatest, keys[i].code);
    }
  };
  add(begin, last);
  add(end - (last - begin), end);
  return octcode_of_range(least, greatest);
}

class PagePlanner {
 public:
  PagePlanner(const WideTree& tree, const std::vector<MortonKey>& keys, const RecordSlots& slots,
              std::uint32_t page_bytes)
      : tree_(tree),
        keys_(keys),
        capacity_(static_cast<std::uint32_t>(page_bytes / kSlotBytes) -
                  frame_head_slots(page_bytes)),
        cut_(cut_treelets(tree, slots, bottom_slots(page_bytes, slots), capacity_)) {
    plan_.page_bytes = page_bytes;
  }

  Result<PagePlan> plan() {
    set_treelet_slots();
    drafts_.emplace_back();
    std::vector<std::uint32_t> below;
    put(drafts_[0], 0);
    for (std::size_t i = 0; i < drafts_.size(); ++i) {
      below.clear();
      fill(drafts_[i].page, below);
      pack(below);
    }
    if (drafts_.size() > LinkFormat::numbered(plan_.page_bytes).max_pages())
      return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                        "%zu pages, more than links can address; build with a larger page size",
                        drafts_.size());
    number_pages();
    return std::move(plan_);
  }

 private:
  void set_treelet_slots() {
    treelet_slots_.resize(tree_.nodes.size());
    for (const Treelet& treelet : cut_.treelets) treelet_slots_[treelet.root] = treelet.slots;
  }

  void put(Draft& draft, std::uint32_t root) {
    draft.slots += treelet_slots_[root];
    draft.page.nodes.push_back(root);
    ++draft.page.root_count;
  }

  // Completes a page from its roots, breadth first. Collects, in order, the roots of the treelets
  // that hang from it.
  void fill(PlannedPage& page, std::vector<std::uint32_t>& below) const {
    for (std::size_t i = 0; i < page.nodes.size(); ++i) {
      const WideNode& node = tree_.nodes[page.nodes[i]];
      for (unsigned c = 0; c < node.child_count; ++c) {
        const WideChild& child = node.children[c];
        if (child.block)
          page.blocks.push_back(child.index);
        else if (cut_.cut_nodes[child.index])
          below.push_back(child.index);
        else
          page.nodes.push_back(child.index);
      }
    }
  }

  // Fills new pages with treelets in Morton order.
  void pack(std::vector<std::uint32_t>& roots) {
    std::stable_sort(roots.begin(), roots.end(), [&](std::uint32_t a, std::uint32_t b) {
      return range_of(a).first < range_of(b).first;
    });
    bool open = false;
    for (const std::uint32_t root : roots) {
      if (!open || drafts_.back().slots + treelet_slots_[root] > capacity_) {
        drafts_.emplace_back();
        open = true;
      }
      put(drafts_.back(), root);
    }
  }

  std::pair<std::uint32_t, std::uint32_t> range_of(std::uint32_t at) const {
    const WideNode& node = tree_.nodes[at];
    return {node.children[0].begin, node.children[node.child_count - 1u].end};
  }

  // Numbers the roots of treelets in preorder: parents come first, so that ordinals ascend
  // downward.
  void give_keys() {
    std::map<std::uint64_t, std::uint32_t> next_ordinal;
    std::vector<std::uint32_t> roots;
    for (const Treelet& treelet : cut_.treelets) roots.push_back(treelet.root);
    std::stable_sort(roots.begin(), roots.end(), [&](std::uint32_t a, std::uint32_t b) {
      const auto [a_begin, a_end] = range_of(a);
      const auto [b_begin, b_end] = range_of(b);
      return a_begin != b_begin ? a_begin < b_begin : a_end > b_end;
    });
    keys_of_nodes_.resize(tree_.nodes.size());
    for (const std::uint32_t root : roots) {
      const auto [begin, end] = range_of(root);
      const std::uint64_t octcode = octcode_of(keys_, begin, end);
      keys_of_nodes_[root] = {octcode, next_ordinal[octcode]++};
    }
  }

  Key key_of(const PlannedPage& page) const {
    Key key{~std::uint64_t{0}, ~std::uint32_t{0}};
    for (std::size_t i = 0; i < page.root_count; ++i)
      key = std::min(key, keys_of_nodes_[page.nodes[i]]);
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
    StoredLink link{number, 0};
    for (const std::uint32_t node : page.nodes) {
      plan_.node_links[node] = link;
      ++link.record;
    }
    link.record = 0;
    for (const std::uint32_t block : page.blocks) {
      plan_.block_links[block] = link;
      ++link.record;
    }
  }

  const WideTree& tree_;
  const std::vector<MortonKey>& keys_;
  std::uint32_t capacity_;
  TreeletCut cut_;
  std::vector<std::uint32_t> treelet_slots_;  // by root
  std::vector<Key> keys_of_nodes_;
  std::vector<Draft> drafts_;
  PagePlan plan_;
};

PagePlan plan_of_block(const std::vector<MortonKey>& keys, std::uint32_t page_bytes) {
  PagePlan plan;
  plan.page_bytes = page_bytes;
  plan.pages.emplace_back();
  plan.pages[0].octcode = octcode_of(keys, 0, static_cast<std::uint32_t>(keys.size()));
  plan.pages[0].blocks = {0};
  plan.block_links = {{0, 0}};
  return plan;
}

}  // namespace

void part_blocks(WideTree& tree, const RecordSlots& slots, std::uint32_t page_bytes) {
  const std::uint32_t most = bottom_slots(page_bytes, slots);
  const std::size_t count = tree.nodes.size();
  for (std::uint32_t at = 0; at < count; ++at) {
    if (slots_with_blocks(tree.nodes[at], slots) <= most) continue;
    for (unsigned child = 0; child < tree.nodes[at].child_count; ++child)
      if (tree.nodes[at].children[child].block) part_block(tree, at, child);
  }
  raise_heights(tree);
}

Result<PagePlan> plan_pages(const WideTree& tree, const std::vector<MortonKey>& keys,
                            const RecordSlots& slots, std::uint32_t page_bytes) {
  if (tree.nodes.empty()) return plan_of_block(keys, page_bytes);
  return PagePlanner(tree, keys, slots, page_bytes).plan();
}

}  // namespace planetree::octree
