#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/predicates.h"

/// How triangles meet the octants and edges of cells.
namespace planetree::octree {

/// A triangle and its box. The box fills one cache line, and mostly nothing else is read.
struct alignas(64) BoxedTriangle {
  explicit BoxedTriangle(const Triangle& triangle)
      : least(least_corner(triangle)), greatest(greatest_corner(triangle)), corners(triangle) {}

  Point least, greatest;
  Triangle corners;
  std::int64_t copies = 1;  ///< triangles with these corners that this one stands for
  bool is_cap = false;      ///< one of these is a cap
};

/// A segment along one axis, from its greater end down to its lesser end.
class DownwardSegment {
 public:
  DownwardSegment(const PerturbedSegment& segment, unsigned axis)
      : segment_(segment), axis_(axis) {}

  /// As octree::crossing(), for all copies of a triangle, but the boxes decide for most triangles.
  /// A triangle whose box does not reach above the segment's lower end on some axis is not crossed,
  /// since the perturbation moves the segment up. Triangles in the sides of cells, which take long
  /// to decide exactly, are among these.
  std::int64_t crossing(const BoxedTriangle& triangle) const {
    const bool near = (triangle.least.array() <= segment_.from.array()).all() &&
                      (triangle.greatest.array() > segment_.to.array()).all();
    if (!near || passes_by(triangle.corners)) return 0;
    return triangle.copies * octree::crossing(segment_, triangle.corners);
  }

 private:
  // Whether the segment certainly passes two edges of the triangle on different sides. What counts
  // is the line of the segment, which seen along the axis is a point.
  bool passes_by(const Triangle& triangle) const {
    const unsigned i = (axis_ + 1) % 3, j = (axis_ + 2) % 3;
    bool left = false, right = false;
    for (unsigned k = 0; k < 3; ++k) {
      const Point a = triangle[k] - segment_.to, b = triangle[(k + 1) % 3] - segment_.to;
      const double one = a[i] * b[j], other = a[j] * b[i];
      const double error = kEdgePassError * (std::fabs(one) + std::fabs(other)) + kProductUnderflow;
      left = left || one - other > error;
      right = right || other - one > error;
    }
    return left && right;
  }
  /// Error of a difference of two products of rounded differences, as a share of the products. Each
  /// product errs by 3 roundings and the difference by one of both; times 4.
  static constexpr double kEdgePassError = 0x1p-49;

  PerturbedSegment segment_;
  unsigned axis_;
};

/// Axis of the edge between two corners of a cell.
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
