#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// Two parallel planes that the surface in a cell of the mask is between: most points of the cell
/// are beyond one of them, and on the side of the cell's corner farthest that way. What is beyond
/// a plane in the cell is convex, and no surface in it.
///
/// Heights are across the planes, from the lower to the upper: of a point at u in the cell, from 0
/// to 1 along each axis, 32 u_a + p u_(a+1) + q u_(a+2) less what that is at the lowest corner; the
/// highest has the height `width`. Every point of the surface in the closed cell has a height of
/// (lower + 1/2) / 256 of the width or more, and of (upper + 1/2) / 256 or less.
///
/// source  bounding planes of a node: "Out-of-core real-time haptic interaction on very large
///         models", section 3; that they tell sides is ours.
struct CellSlab {
  static constexpr int kSteps = 32;  ///< of slopes, in 1
  static constexpr std::uint8_t kNoLower = 0, kNoUpper = 255;

  std::uint16_t direction = make_direction(0, 0, 0);  ///< axis a, 32 + p, 32 + q: 2, 7, 7 bits
  std::uint8_t lower = kNoLower;
  std::uint8_t upper = kNoUpper;

  /// axis    0 to 2
  /// slopes  p, q: -32 to 32
  static constexpr std::uint16_t make_direction(unsigned axis, int p, int q) {
    return static_cast<std::uint16_t>(axis | static_cast<unsigned>(p + kSteps) << 2 |
                                      static_cast<unsigned>(q + kSteps) << 9);
  }
  constexpr unsigned axis() const { return direction & 3; }
  constexpr int p() const { return static_cast<int>(direction >> 2 & 127) - kSteps; }
  constexpr int q() const { return static_cast<int>(direction >> 9) - kSteps; }
  constexpr bool direction_is_valid() const { return axis() < 3 && p() <= kSteps && q() <= kSteps; }
  constexpr bool says_something() const { return lower != kNoLower || upper != kNoUpper; }
  constexpr bool operator==(const CellSlab&) const = default;

  /// Where a point is in a cell of a level, by its least corner: from 0 to 1 along each axis, or
  /// to another end where the cell's sides are rounded.
  static Point position_in(const Point& point, const Point& lower, unsigned level) {
    return (point - lower) * (0.5 * static_cast<double>(1U << level));
  }
  constexpr int width() const { return kSteps + std::abs(p()) + std::abs(q()); }
  /// Of a point at `u` in the cell; right within 2^-40 where `u` is below 256.
  double height(const Point& u) const {
    const unsigned a = axis();
    const int lowest = std::min(p(), 0) + std::min(q(), 0);
    return kSteps * u[a] + (p() * u[a == 2 ? 0 : a + 1] + q() * u[a == 0 ? 2 : a - 1]) - lowest;
  }
  /// Which plane a height of the cell is beyond: 1 above, -1 below, 0 neither.
  int side_of(double height) const {
    if (upper != kNoUpper && 256 * height >= (upper + 1) * width()) return 1;
    if (lower != kNoLower && 256 * height <= lower * width()) return -1;
    return 0;
  }
  /// The cell's highest corner, bits as those of GridCell::child(); the lowest is diagonal to it.
  constexpr unsigned highest_corner() const {
    const unsigned a = axis();
    return 1U << a | static_cast<unsigned>(p() >= 0) << (a + 1) % 3 |
           static_cast<unsigned>(q() >= 0) << (a + 2) % 3;
  }

  static constexpr unsigned kNoCorner = 8;
  /// The corner that is beyond the same plane as a point at `u` in the cell; kNoCorner if the point
  /// is beyond neither.
  unsigned corner_beyond(const Point& u) const {
    const int side = side_of(height(u));
    if (side == 0) return kNoCorner;
    return side > 0 ? highest_corner() : 7 - highest_corner();
  }

  /// As frames hold it.
  constexpr std::uint32_t word() const {
    return std::uint32_t{direction} | std::uint32_t{lower} << 16 | std::uint32_t{upper} << 24;
  }
  static constexpr CellSlab of_word(std::uint32_t word) {
    CellSlab slab;
    slab.direction = static_cast<std::uint16_t>(word);
    slab.lower = static_cast<std::uint8_t>(word >> 16);
    slab.upper = static_cast<std::uint8_t>(word >> 24);
    return slab;
  }
};

}  // namespace planetree::octree
