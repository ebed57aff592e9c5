#include "query/answer/side_search.h"

#include <array>
#include <span>

#include "octree/geometry/clipped_grid.h"
#include "octree/geometry/strict_math.h"
#include "query/answer/exit_segments.h"

namespace planetree::query {

using octree::Point;

SideResult SideSearch::run() {
  if (search_mask()) return side_result_;
  // Usually the first way tells; another may do without a page that is lost.
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
  // What is resident, answers that remember depend on anyway. Lists are long: made where it stays.
  const octree::MaskLookup found =
      lookup_ ? octree::look_up(model_.mask, *lookup_, point_, work_left(), pages_, work_)
              : octree::look_up(model_.mask, point_, work_left(), pages_, work_);
  // What a special cell knows is of this point alone.
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

// What is beyond the planes of a cell has the winding number of its corner there.
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

// To the corner of the octant that the point is in: past those blocks alone that have triangles
// in the octant.
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
  // Most often there is nothing to clip.
  if (!model_.region.has_walls())
    return decide_by_slab(found) || cross_within_octant(found, octree::CellGrid(lower));
  return cross_within_octant(found, octree::ClippedGrid(lower, model_.region));
}

// The nearest corner, or the last point if that is nearer: few triangles are between.
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

// To where the winding number is known. False if that way cannot be gone.
bool SideSearch::cross_to(const Point& end, std::int64_t winding, SideReason::Rule rule) {
  if (work_left() == 0) return false;
  return finalize(end, winding,
                  octree::count_crossings(model_.tree, {point_, end}, work_left(), pages_, work_),
                  rule);
}

// From what lies between the point and an end where the winding number is known.
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
