#include "octree/mask/mask_lookup.h"

#include <algorithm>

#include "octree/geometry/octcode.h"
#include "octree/geometry/predicates.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/work_limit.h"
#include "octree/mask/side_grid.h"

namespace planetree::octree {
namespace {

/// Finds on which side of a special cell's planes the point is.
void find_by_planes(const MaskSpecial& special, const double* planes, const Point& point,
                    WorkLimit& limit, MaskLookup& found) {
  if (!limit.take(special.plane_count)) return;
  bool beyond = false, perturbed_beyond = false, on_plane = false;
  for (unsigned i = 0; i < special.plane_count; ++i) {
    const Triangle plane = mask_plane(planes, i);
    const int side = orientation(plane[0], plane[1], plane[2], point, &limit);
    beyond = beyond || side > 0;
    on_plane = on_plane || side == 0;
    perturbed_beyond =
        perturbed_beyond || (side != 0 ? side : perturbed_side(plane, point, &limit)) > 0;
  }
  if (limit.exceeded()) return;
  found.kind = MaskLookup::Kind::kPlanes;
  found.winding = perturbed_beyond ? int{special.beyond} : int{special.behind};
  found.on_surface = on_plane && !beyond;
}

// Copies the list of a cell, because its page may be gone after the next lookup of a page.
void read_list(const MaskListed& listed, const MaskRecords& records, MaskLookup& found) {
  // A cell of the last level has no octants, so that its list has no meaning.
  if (found.cell.level == kLevels) return;
  found.kind = MaskLookup::Kind::kCorners;
  found.listed = listed;
  copy_list(records.slot(0), listed, found.blocks);
  // If the file was replaced after the side grid was filled, these bytes may be no list.
  if (!found.blocks.slab.direction_is_valid()) found.blocks.slab = {};
}

void read_leaf(const std::byte* record, const MaskRecords& records, const Point& point,
               WorkLimit& limit, MaskLookup& found) {
  const auto& corners = *reinterpret_cast<const MaskCorners*>(record);
  if (is_special(corners)) {
    const auto& special = *reinterpret_cast<const MaskSpecial*>(record);
    const auto* planes = reinterpret_cast<const double*>(records.slot(special.plane_slot));
    find_by_planes(special, planes, point, limit, found);
  } else if (is_listed(corners)) {
    read_list(*reinterpret_cast<const MaskListed*>(record), records, found);
  } else if (corners[0] != kUncounted) {
    found.kind = MaskLookup::Kind::kCorners;
    found.corners = corners;
  }
}

// Goes down from the node of the cell reached so far. octant_in(cell) returns the octant of a cell
// that the point is in.
template <class OctantIn>
void go_down(MaskRecords& records, const MaskNode& from, const Point& point, WorkLimit& limit,
             const OctantIn& octant_in, TraversalStats& work, MaskLookup& found) {
  MaskNode node = from;
  // Stops at the last level: a forged mask could be deeper.
  for (unsigned left = kLevels - found.cell.level; left > 0 && limit.take(); --left) {
    ++work.nodes;
    const unsigned octant = octant_in(found.cell);
    found.cell = found.cell.child(octant);
    if (!node.is_grey(octant)) {
      found.kind = MaskLookup::Kind::kColour;
      found.winding = node.winding(octant);
      return;
    }
    const std::byte* record = records.child(node, octant, work);
    if (!record) return;
    if (node.is_leaf(octant)) return read_leaf(record, records, point, limit, found);
    node = *reinterpret_cast<const MaskNode*>(record);
  }
}

// Looks a point up from the root down.
void look_from_root(const MaskInfo& mask, const Point& point, WorkLimit& limit,
                    const PageReader& pages, TraversalStats& work, MaskLookup& found) {
  if (mask.page_count == 0 || limit.spent() || !mask.reaches(point)) return;
  MaskRecords records(mask, pages);
  const std::byte* record = records.root(work);
  if (!record) return;
  if (!records.root_is_node()) return read_leaf(record, records, point, limit, found);
  const std::uint64_t octants = CellGrid(mask.lower).finest(point).first_code();
  const auto octant_in = [octants](const GridCell& cell) {
    return static_cast<unsigned>(octants >> 3 * (kLevels - cell.level - 1) & 7);
  };
  go_down(records, *reinterpret_cast<const MaskNode*>(record), point, limit, octant_in, work,
          found);
}

// Looks a point up from the record that the side grid found for it.
void look_from(const SideGrid::Lookup& lookup, const MaskInfo& mask, const Point& point,
               WorkLimit& limit, const PageReader& pages, TraversalStats& work, MaskLookup& found) {
  found.cell = lookup.cell;
  MaskRecords records(mask, pages);
  const SideGridRecord& record = *lookup.record;
  if (record.is_listed()) {
    // The list was valid when the side grid was filled; the file may have been replaced since.
    const MaskListed listed = record.listed(records.slot_of(record.link));
    if (records.fits_in_page(record.link, list_slots(listed.block_count)) &&
        records.switch_to_page_of(record.link, work))
      read_list(listed, records, found);
  } else if (record.is_leaf()) {
    const std::byte* leaf = records.record(record.link, true, work);
    if (leaf) read_leaf(leaf, records, point, limit, found);
  } else {
    const CellGrid grid(mask.lower);
    const auto octant_in = [&](const GridCell& cell) { return grid.octant(cell, point); };
    go_down(records, record.node(), point, limit, octant_in, work, found);
  }
}

}  // namespace

MaskLookup look_up(const MaskInfo& mask, const Point& point, std::uint64_t max_work,
                   const PageReader& pages, TraversalStats& work) noexcept {
  MaskLookup found;
  WorkLimit limit(work.units, max_work);
  look_from_root(mask, point, limit, pages, work, found);
  return found;
}

MaskLookup look_up(const MaskInfo& mask, const SideGrid::Lookup& lookup, const Point& point,
                   std::uint64_t max_work, const PageReader& pages, TraversalStats& work) noexcept {
  MaskLookup found;
  WorkLimit limit(work.units, max_work);
  if (lookup.record && !limit.spent())
    look_from(lookup, mask, point, limit, pages, work, found);
  else
    look_from_root(mask, point, limit, pages, work, found);
  return found;
}

}  // namespace planetree::octree
