#pragma once

#include <array>
#include <cstdint>

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// Finds the octants of a cell that triangles may touch. The result for each octant is that of
/// may_touch(), at a tenth of the cost: float decides for nearly all octants, many triangles at a
/// time.
///
/// threads  one.
class OctantOverlap {
 public:
  static constexpr unsigned kAtOnce = 16;

  /// middle  common corner of the octants; all points in the model frame.
  OctantOverlap(const Point& lower, const Point& middle, const Point& upper);

  bool full() const { return count_ == kAtOnce; }
  /// Adds a triangle. Must not be called while full().
  /// octants  the octants to be decided, one bit each.
  /// index    identifies the triangle to the caller.
  void add(const Triangle& triangle, unsigned octants, std::uint32_t index);

  /// Which of their octants the triangles may touch, for the triangles added since the last take():
  /// the first `count` elements, in the order in which they were added.
  struct TouchedOctants {
    unsigned count = 0;
    std::array<std::uint8_t, kAtOnce> octants;
    std::array<std::uint32_t, kAtOnce> indices;
  };
  TouchedOctants take();

  /// A cell and triangles in float, relative to the middle of the cell.
  struct FloatTriangles {
    float lower[3], upper[3];
    alignas(64) float corner[3][3][kAtOnce];  // by corner, axis, triangle
  };
  /// What float decides: one bit for each octant.
  struct FloatResult {
    std::uint8_t touched[kAtOnce];
    std::uint8_t unsure[kAtOnce];
  };

 private:
  bool touches(unsigned at, unsigned octant) const;

  const std::array<Point, 3> sides_;  // lower, middle, upper
  bool float_decides_ = true;
  FloatTriangles in_float_;
  unsigned count_ = 0;
  std::array<Triangle, kAtOnce> triangles_;
  std::array<std::uint8_t, kAtOnce> octants_;
  std::array<std::uint32_t, kAtOnce> indices_;
};

}  // namespace planetree::octree
