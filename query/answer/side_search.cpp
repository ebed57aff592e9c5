#include "query/answer/side_search.h"

#include <array>
#include <span>

#include "octree/geometry/cell_grid.h"
#include "octree/geometry/strict_math.h"

namespace planetree::query {

using octree::Point;

SideResult SideSearch::run() { return search_mask() ? side_result_ : cross_out(); }

SideResult SideSearch::count_exactly(std::uint64_t max_work) {
  work_before_ = work_.units;
  max_work_ = max_work;
  return cross_out();
}

SideResult SideSearch::cross_out() {
  // Usually the first segment decides. Another may do without a page that is missing.
  const octree::Region& region = model_.region;
  const ExitSegments segments(model_.tree, point_);
  for (const ExitSegments::Segment& segment : segments.all())
    if (region.holds(segment.end) && cross_to(segment.end, 0, SideReason::Rule::kWayOut))
      return side_result_;
  if (region.has_walls() &&
      cross_to(model_.region_corner, model_.region_winding, SideReason::Rule::kWayOut))
    return side_result_;
  return {Side::kUnknown, Status::kDegraded};
}

bool SideSearch::search_mask() {
  using Kind = octree::MaskLookup::Kind;
  if (cache_)
    if (const octree::MaskLookup* last = cache_->cell_with(point_)) return use_lookup(*last);
  // Starting at the grid's record skips the upper levels of the mask. A search with hints may do
  // so, since its result may depend on resident pages anyway. `found` is initialized in place,
  // because a MaskLookup is large.
  const octree::MaskLookup found =
      lookup_ ? octree::look_up(model_.mask, *lookup_, point_, work_left(), pages_, work_)
              : octree::look_up(model_.mask, point_, work_left(), pages_, work_);
  // The lookup in a special cell holds for this point only.
  const bool holds_in_cell = found.kind == Kind::kColour || found.kind == Kind::kCorners;
  if (cache_ && holds_in_cell && cache_->is_near(point_, model_.tree))
    cache_->note_cell(model_.mask, found);
  return use_lookup(found);
}

bool SideSearch::use_lookup(const octree::MaskLookup& found) {
  using Kind = octree::MaskLookup::Kind;
  if (reason_) {
    reason_->in_mask = model_.mask.page_count > 0;
    reason_->cell = found.cell;
  }
  if (found.kind == Kind::kCorners) return cross_to_corner(found);
  if (found.kind == Kind::kNothing) return false;
  if (reason_)
    reason_->rule =
        found.kind == Kind::kColour ? SideReason::Rule::kColour : SideReason::Rule::kPlanes;
  has_exact_winding_ = found.kind == Kind::kPlanes || found.winding == 0;
  set_result(found.winding, found.on_surface);
  return true;
}

// Decides by the slab of the cell: a point beyond one of its planes has the winding number of the
// cell's corner there.
bool SideSearch::decide_by_slab(const octree::MaskLookup& found) {
  const octree::CellSlab& slab = found.blocks.slab;
  if (!slab.has_plane()) return false;
  const Point lower = octree::CellGrid(model_.mask.lower).lower(found.cell);
  const unsigned corner =
      slab.corner_beyond(octree::CellSlab::position_in(point_, lower, found.cell.level));
  if (corner == octree::CellSlab::kNoCorner) return false;
  if (reason_) reason_->rule = SideReason::Rule::kSlab;
  has_exact_winding_ = true;
  set_result(octree::corner_number(found.listed, corner), false);
  return true;
}

// Counts crossings to the cell's corner in the octant that the point is in. Only the blocks that
// have triangles in that octant count.
template <class Grid>
bool SideSearch::cross_within_octant(const octree::MaskLookup& found, const Grid& grid) {
  const unsigned octant = grid.octant(found.cell, point_);
  std::array<std::uint32_t, octree::kMaxListed> links;
  const unsigned count = found.blocks.in_octant(octant, links);
  const Point corner = grid.corner(found.cell, octant);
  const int winding = octree::corner_number(found.listed, octant);
  if (count == 0) return finalize(corner, winding, {}, SideReason::Rule::kCorner);
  const octree::Crossings crossings = octree::count_crossings(
      model_.tree, {point_, corner}, std::span(links).first(count), work_left(), pages_, work_);
  return finalize(corner, winding, crossings, SideReason::Rule::kCorner);
}

bool SideSearch::cross_to_corner(const octree::MaskLookup& found) {
  if (found.blocks.count == 0) return cross_to_nearest_end(found);
  const Point& lower = model_.mask.lower;
  // Most files have no region. Their octants need no clipping. Only there slabs are used.
  if (!model_.region.has_walls())
    return decide_by_slab(found) || cross_within_octant(found, octree::CellGrid(lower));
  return cross_within_octant(found, octree::ClippedGrid(lower, model_.region));
}

// Counts crossings to the nearest corner, or to the last point if that is nearer, because few
// triangles lie between.
bool SideSearch::cross_to_nearest_end(const octree::MaskLookup& found) {
  const octree::ClippedGrid grid(model_.mask.lower, model_.region);
  Point corner = grid.lower(found.cell);
  const Point upper = grid.upper(found.cell);
  unsigned nearest = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const bool is_upper = point_[axis] - corner[axis] > upper[axis] - point_[axis];
    if (is_upper) corner[axis] = upper[axis];
    nearest |= static_cast<unsigned>(is_upper) << axis;
  }
  if (cache_ && cache_->has_exact_winding() &&
      (cache_->point() - point_).squaredNorm() < (corner - point_).squaredNorm() &&
      cross_to(cache_->point(), cache_->side_result().winding, SideReason::Rule::kCorner))
    return true;
  return cross_to(corner, found.corners[nearest], SideReason::Rule::kCorner);
}

// Counts crossings to an end of known winding number.
bool SideSearch::cross_to(const Point& end, std::int64_t winding, SideReason::Rule rule) {
  if (work_left() == 0) return false;
  return finalize(end, winding,
                  octree::count_crossings(model_.tree, {point_, end}, work_left(), pages_, work_),
                  rule);
}

// Sets the result from the crossings between the point and an end of known winding number.
bool SideSearch::finalize(const Point& end, std::int64_t winding,
                          const octree::Crossings& crossings, SideReason::Rule rule) {
  if (!crossings.complete) return false;
  if (reason_) {
    reason_->rule = rule;
    reason_->end = end;
    reason_->known = winding;
    reason_->crossings = crossings.difference;
  }
  has_exact_winding_ = true;
  set_result(winding + crossings.difference, crossings.on_surface);
  return true;
}

void SideSearch::set_result(std::int64_t winding, bool on_surface) {
  const Side off_surface = winding != 0 ? Side::kInside : Side::kOutside;
  side_result_ = {on_surface ? Side::kOnSurface : off_surface, Status::kExact, winding};
}

}  // namespace planetree::query
