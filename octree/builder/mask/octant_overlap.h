#pragma once

#include <array>
#include <cstdint>

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// The octants of a cell that triangles may touch, as may_touch() tells it of each, at a tenth of
/// the cost: float tells nearly all of them, many triangles side by side.
///
/// threads  one.
class OctantOverlap {
 public:
  static constexpr unsigned kAtOnce = 16;

  /// middle  the octants' common corner; all model frame.
  OctantOverlap(const Point& lower, const Point& middle, const Point& upper);

  bool full() const { return count_ == kAtOnce; }
  /// A triangle, while not full.
  /// octants  those to be told, one bit each.
  /// place    the caller's, to know it by.
  void add(const Triangle& triangle, unsigned octants, std::uint32_t index);

  /// Of the triangles since the last time, those of their octants that they may touch, in the order
  /// in which they were added: the first `count`.
  struct Certain {
    unsigned count = 0;
    std::array<std::uint8_t, kAtOnce> octants;
    std::array<std::uint32_t, kAtOnce> indices;
  };
  Certain take();

  /// What float sees of a cell and triangles, from the cell's middle.
  struct Seen {
    float lower[3], upper[3];
    alignas(64) float corner[3][3][kAtOnce];  // by corner, axis, triangle
  };
  /// What it tells: a bit for each octant.
  struct Sure {
    std::uint8_t touched[kAtOnce];
    std::uint8_t unsure[kAtOnce];
  };

 private:
  bool touches(unsigned at, unsigned octant) const;

  const std::array<Point, 3> sides_;  // lower, middle, upper
  bool certain_by_float_ = true;
  Seen seen_;
  unsigned count_ = 0;
  std::array<Triangle, kAtOnce> triangles_;
  std::array<std::uint8_t, kAtOnce> octants_;
  std::array<std::uint32_t, kAtOnce> indices_;
};

}  // namespace planetree::octree
