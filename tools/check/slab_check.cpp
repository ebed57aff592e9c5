#include "tools/check/slab_check.h"

#include <algorithm>
#include <vector>

#include "octree/geometry/strict_math.h"

namespace planetree::tools {
namespace {

using octree::Point;
using Polygon = std::vector<Point>;

/// Allowed rounding, as a share of a step, which is 1/256 of CellSlab::width().
constexpr double kRounding = 0x1p-20;

// Clips a polygon to the half space `sign` * (x[axis] - at) >= 0 (Sutherland and Hodgman 1974).
Polygon clipped(const Polygon& polygon, unsigned axis, double at, double sign) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double here = sign * (from[axis] - at), there = sign * (to[axis] - at);
    if (here >= 0) kept.push_back(from);
    if ((here < 0) != (there < 0)) kept.push_back(from + (to - from) * (here / (here - there)));
  }
  return kept;
}

}  // namespace

bool is_within_slab(const octree::CellSlab& slab, const octree::Triangle& triangle,
                    const octree::Point& lower, const octree::Point& upper, unsigned level) {
  const double step = slab.width() / 256.0, rounding = kRounding * step;
  const double least = (slab.lower + 0.5) * step, greatest = (slab.upper + 0.5) * step;
  const auto is_within = [&](const Point& at) {
    const double height = slab.height(at);
    return (slab.lower == octree::CellSlab::kNoLower || height >= least - rounding) &&
           (slab.upper == octree::CellSlab::kNoUpper || height <= greatest + rounding);
  };
  Polygon polygon;
  for (const Point& corner : triangle)
    polygon.push_back(octree::CellSlab::position_in(corner, lower, level));
  // In most cases all corners are within, and nothing need be clipped.
  if (std::all_of(polygon.begin(), polygon.end(), is_within)) return true;
  const Point end = octree::CellSlab::position_in(upper, lower, level);
  for (unsigned axis = 0; axis < 3; ++axis) {
    polygon = clipped(polygon, axis, 0, 1);
    polygon = clipped(polygon, axis, end[axis], -1);
  }
  return std::all_of(polygon.begin(), polygon.end(), is_within);
}

}  // namespace planetree::tools
