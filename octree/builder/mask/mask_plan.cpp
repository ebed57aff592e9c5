#include "octree/builder/mask/mask_plan.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "octree/geometry/cell_grid.h"

namespace planetree::octree {
namespace {

/// A node whose family is to be put into a page, and its cell.
struct Divided {
  std::uint32_t node = 0;
  GridCell cell;
};

struct Draft {
  std::vector<Divided> roots;  ///< none for the page of the mask's root
  PlannedMaskPage page;
};

class MaskPlanner {
 public:
  MaskPlanner(const MaskTree& mask, std::uint32_t page_bytes, const MaskRoot& root)
      : mask_(mask),
        root_(root),
        capacity_(static_cast<std::uint32_t>(page_bytes / kMaskSlotBytes) -
                  mask_head_slots(page_bytes)) {
    plan_.page_bytes = page_bytes;
  }

  MaskPlan plan() {
    if (root_.apart && !has_family(0)) return std::move(plan_);
    measure();
    drafts_.emplace_back();
    if (root_.apart) drafts_[0].roots.push_back({0, root_.cell});
    for (std::size_t i = 0; i < drafts_.size(); ++i) pack(fill(drafts_[i]));
    number_pages();
    return std::move(plan_);
  }

 private:
  std::uint32_t entry_slots(std::uint32_t at) const {
    const MaskEntry& entry = mask_.entries[at];
    if (entry.kind == MaskEntry::Kind::kSpecial)
      return 1 + kPlaneSlots * mask_.specials[entry.first].plane_count;
    if (entry.kind == MaskEntry::Kind::kListed)
      return 1 + list_slots(mask_.lists[entry.first].count);
    return 1;
  }

  std::uint32_t family_slots(std::uint32_t node) const {
    std::uint32_t slots = 0;
    for (std::uint32_t i = 0; i < members(node); ++i)
      slots += entry_slots(mask_.entries[node].first + i);
    return slots;
  }

  std::uint32_t members(std::uint32_t node) const {
    if (mask_.entries[node].kind != MaskEntry::Kind::kNode) return 0;
    return static_cast<std::uint32_t>(std::popcount(mask_.entries[node].grey));
  }
  bool has_family(std::uint32_t at) const { return members(at) > 0; }

  // Slots of everything below each node. Children come after their parents.
  void measure() {
    below_.resize(mask_.entries.size());
    for (auto at = static_cast<std::uint32_t>(below_.size()); at-- > 0;) {
      if (!has_family(at)) continue;
      below_[at] = family_slots(at);
      for (std::uint32_t i = 0; i < members(at); ++i)
        below_[at] += below_[mask_.entries[at].first + i];
    }
  }

  // Puts families into a page, breadth first, while they fit. Returns those that do not fit.
  std::vector<Divided> fill(Draft& draft) const {
    std::vector<Divided> queue, left;
    std::uint32_t slots = 0;
    const auto put = [&](const Divided& divided) {
      slots += family_slots(divided.node);
      std::uint32_t member = mask_.entries[divided.node].first;
      for (unsigned octant = 0; octant < 8; ++octant) {
        if ((mask_.entries[divided.node].grey >> octant & 1) == 0) continue;
        draft.page.entries.push_back(member);
        if (has_family(member)) queue.push_back({member, divided.cell.child(octant)});
        ++member;
      }
    };
    if (draft.roots.empty()) {
      slots += entry_slots(0);
      draft.page.entries.push_back(0);
      if (has_family(0)) queue.push_back({0, root_.cell});
    }
    for (const Divided& root : draft.roots) put(root);
    draft.page.root_count = static_cast<std::uint32_t>(draft.page.entries.size());
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const Divided divided = queue[i];
      if (slots + family_slots(divided.node) <= capacity_)
        put(divided);
      else
        left.push_back(divided);
    }
    return left;
  }

  // Starts new pages with families, as many in each as fit together with everything below them.
  void pack(const std::vector<Divided>& families) {
    std::uint64_t slots = 0;
    bool open = false;
    for (const Divided& family : families) {
      slots += below_[family.node];
      if (!open || slots > capacity_) {
        drafts_.emplace_back();
        slots = below_[family.node];
        open = true;
      }
      drafts_.back().roots.push_back(family);
    }
  }

  void number_pages() {
    for (Draft& draft : drafts_) {
      const auto octcode = [](std::uint64_t least, const Divided& divided) {
        return std::min(least, divided.cell.octcode());
      };
      const std::uint64_t none = draft.roots.empty() ? 0 : ~std::uint64_t{0};
      draft.page.octcode = std::accumulate(draft.roots.begin(), draft.roots.end(), none, octcode);
      plan_.pages.push_back(std::move(draft.page));
    }
    std::sort(
        plan_.pages.begin(), plan_.pages.end(),
        [](const PlannedMaskPage& a, const PlannedMaskPage& b) { return a.octcode < b.octcode; });
    std::vector<StoredLink> entry_links(mask_.entries.size());
    for (std::uint32_t number = 0; number < plan_.pages.size(); ++number) {
      plan_.pages[number].number = number;
      StoredLink link{number, 0};
      for (const std::uint32_t entry : plan_.pages[number].entries) {
        entry_links[entry] = link;
        ++link.record;
      }
    }
    plan_.families.resize(mask_.entries.size());
    for (std::uint32_t at = 0; at < mask_.entries.size(); ++at)
      if (has_family(at)) plan_.families[at] = entry_links[mask_.entries[at].first];
  }

  const MaskTree& mask_;
  const MaskRoot root_;
  const std::uint32_t capacity_;
  std::vector<std::uint32_t> below_;
  std::vector<Draft> drafts_;
  MaskPlan plan_;
};

}  // namespace

MaskPlan plan_mask(const MaskTree& mask, std::uint32_t page_bytes, const MaskRoot& root) {
  return MaskPlanner(mask, page_bytes, root).plan();
}

}  // namespace planetree::octree
