#include "octree/builder/surface/edge_count.h"

#include "octree/geometry/strict_math.h"

namespace planetree::octree {

EdgeCount::EdgeCount(const std::array<Point, 8>& corners, std::int64_t winding,
                     const std::vector<BoxedTriangle>& triangles,
                     const std::vector<std::uint32_t>& positions)
    : corners_(corners), winding_(winding), triangles_(triangles) {
  for (const std::uint32_t position : positions) {
    const unsigned sides = sides_crossed(triangles[position]);
    if ((sides & (sides - 1)) != 0 && !has_equal_corners(triangles[position].corners))
      near_.push_back({position, sides});
  }
}

std::array<std::int64_t, 8> EdgeCount::all() const {
  std::array<std::int64_t, 8> winding{winding_};
  for (unsigned which = 1; which < 8; ++which) {
    const unsigned before = which & (which - 1);
    winding[which] = winding[before] + rise(which, before);
  }
  return winding;
}

std::int64_t EdgeCount::rise(unsigned which, unsigned before) const {
  const DownwardSegment down({corners_[which], corners_[before]}, axis_of_edge(which, before));
  // The two sides of the cell that the edge lies in.
  const unsigned needed = (~(which | before) & 7) | (which & before) << 3;
  std::int64_t sum = 0;
  for (const auto& [position, sides] : near_)
    if ((sides & needed) == needed) sum += down.crossing(triangles_[position]);
  return sum;
}

// A bit for each lower side of the cell whose plane the triangle's box crosses by the rule of
// DownwardSegment, and behind those a bit for each upper side.
unsigned EdgeCount::sides_crossed(const BoxedTriangle& triangle) const {
  unsigned crossed = 0;
  for (unsigned axis = 0; axis < 3; ++axis)
    for (unsigned upper = 0; upper < 2; ++upper) {
      const double side = corners_[upper * 7][axis];
      const bool crosses = triangle.least[axis] <= side && triangle.greatest[axis] > side;
      crossed |= static_cast<unsigned>(crosses) << (axis + 3 * upper);
    }
  return crossed;
}

}  // namespace planetree::octree
