#pragma once

#include <array>
#include <cstdint>

#include "octree/predicates.h"

/// What triangles are to cells' octants and edges.
namespace planetree::octree {

/// A triangle and its box.
struct BoxedTriangle {
  explicit BoxedTriangle(const Triangle& triangle)
      : corners(triangle),
        least(triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2])),
        greatest(triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2])) {}

  Triangle corners;
  Point least, greatest;
};

/// A segment that leads down along every axis, from the greater end to the lesser.
class DownwardSegment {
 public:
  explicit DownwardSegment(const MovedSegment& segment) : segment_(segment) {}

  /// As octree::crossing(), but most triangles are told apart by their boxes. One that is no
  /// higher than the segment is below it: such are those in the sides of cells, which take long
  /// to tell otherwise.
  std::int64_t crossing(const BoxedTriangle& triangle) const {
    const bool near = (triangle.least.array() <= segment_.from.array()).all() &&
                      (triangle.greatest.array() > segment_.to.array()).all();
    return near ? octree::crossing(segment_, triangle.corners) : 0;
  }

 private:
  MovedSegment segment_;
};

/// Octants about `middle` that the triangle's box touches, one bit each.
inline unsigned octants_of_box(const BoxedTriangle& triangle, const Point& middle) {
  constexpr std::array<unsigned, 3> kUpperOctants = {0xaa, 0xcc, 0xf0};
  unsigned octants = 0xff;
#pragma GCC unroll 3
  for (unsigned axis = 0; axis < 3; ++axis) {
    const unsigned upper = kUpperOctants[axis];
    octants &= triangle.least[axis] > middle[axis] ? upper : 0xff;
    octants &= triangle.greatest[axis] < middle[axis] ? ~upper : 0xff;
  }
  return octants;
}

}  // namespace planetree::octree
