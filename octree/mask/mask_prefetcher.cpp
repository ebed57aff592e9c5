#include "octree/mask/mask_prefetcher.h"

#include <cassert>
#include <utility>

#include "octree/geometry/strict_math.h"
#include "octree/mask/mask_lookup.h"

namespace planetree::octree {

MaskPrefetcher::MaskPrefetcher(const MaskInfo& mask, const SideGrid& side_grid, const Point& point)
    : mask_(mask), point_(point) {
  const SideGrid::Lookup lookup = side_grid.lookup_of(point);
  if (!lookup.record) return;
  record_ = lookup.record;
  cell_ = lookup.cell;
  next_ = Next::kGridRecord;
  __builtin_prefetch(record_);
}

void MaskPrefetcher::step(const PageReader& pages) noexcept {
  assert(goes_on());
  const Next now = std::exchange(next_, Next::kNothing);
  if (now == Next::kGridRecord) {
    if (record_->is_node()) return go_below(record_->node(), pages);
    if (record_->is_listed()) prefetch_at(record_->link, pages);
    if (!record_->is_leaf()) return;
    next_ = Next::kLeaf;
    link_ = record_->link;
    prefetch_at(link_, pages);
    return;
  }
  const std::byte* record = prefetch_at(link_, pages);
  if (!record) return;
  if (now == Next::kNode) return go_below(*reinterpret_cast<const MaskNode*>(record), pages);
  if (!is_listed(*reinterpret_cast<const MaskCorners*>(record))) return;
  const MaskLinkFormat links(mask_.page_bytes);
  const auto& listed = *reinterpret_cast<const MaskListed*>(record);
  prefetch_at(links.make(links.page(link_), listed.list_slot), pages);
}

void MaskPrefetcher::go_below(const MaskNode& node, const PageReader& pages) {
  if (cell_.level >= kLevels) return;  // only in a forged mask
  const unsigned octant = CellGrid(mask_.lower).octant(cell_, point_);
  if (!node.is_grey(octant)) return;
  cell_ = cell_.child(octant);
  link_ = MaskRecords(mask_, pages).child_link(node, octant);
  next_ = node.is_leaf(octant) ? Next::kLeaf : Next::kNode;
  prefetch_at(link_, pages);
}

// Prefetches what a link leads to, and returns it; null if its page is not resident.
const std::byte* MaskPrefetcher::prefetch_at(MaskLink link, const PageReader& pages) const {
  const std::byte* record = MaskRecords(mask_, pages).peek(link);
  if (record) __builtin_prefetch(record);
  return record;
}

}  // namespace planetree::octree
