#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "octree/geometry/predicates.h"

/// What triangles are to cells' octants and edges.
namespace planetree::octree {

/// A triangle and its box, the box in one line of memory: mostly no more is looked at.
struct alignas(64) BoxedTriangle {
  explicit BoxedTriangle(const Triangle& triangle)
      : least(triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2])),
        greatest(triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2])),
        corners(triangle) {}

  Point least, greatest;
  Triangle corners;
};

/// A segment that leads down along one axis, from the greater end to the lesser.
class DownwardSegment {
 public:
  DownwardSegment(const PerturbedSegment& segment, unsigned axis)
      : segment_(segment), axis_(axis) {}

  /// As octree::crossing(), but most triangles are told apart by their boxes. One that is no
  /// higher than the segment is below it: such are those in the sides of cells, which take long
  /// to tell otherwise.
  std::int64_t crossing(const BoxedTriangle& triangle) const {
    const bool near = (triangle.least.array() <= segment_.from.array()).all() &&
                      (triangle.greatest.array() > segment_.to.array()).all();
    return near && !passes_by(triangle.corners) ? octree::crossing(segment_, triangle.corners) : 0;
  }

 private:
  // Whether two of the triangle's edges are certainly passed on different sides. They are passed
  // as the segment's line is, which seen along the axis is a point.
  bool passes_by(const Triangle& triangle) const {
    const unsigned i = (axis_ + 1) % 3, j = (axis_ + 2) % 3;
    bool left = false, right = false;
    for (unsigned k = 0; k < 3; ++k) {
      const Point a = triangle[k] - segment_.to, b = triangle[(k + 1) % 3] - segment_.to;
      const double one = a[i] * b[j], other = a[j] * b[i];
      const double error = kError * (std::fabs(one) + std::fabs(other)) + kUnderflow;
      left = left || one - other > error;
      right = right || other - one > error;
    }
    return left && right;
  }
  /// Of a difference of products of differences, each rounded; and of products that underflow.
  static constexpr double kError = 0x1p-49;
  static constexpr double kUnderflow = 0x1p-1000;

  PerturbedSegment segment_;
  unsigned axis_;
};

/// The axis of the edge between two of a cell's corners.
inline unsigned axis_of_edge(unsigned which, unsigned before) {
  return static_cast<unsigned>(std::countr_zero(which ^ before));
}

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
