#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// Two parallel planes that enclose the surface within a cell of the mask. Most points of the cell
/// lie beyond one of the planes. Such a point has the same winding number as the cell's farthest
/// corner in that direction: the part of the cell beyond a plane is convex and contains no surface.
///
/// Heights are measured across the planes, from the lower to the upper. With u the position in the
/// cell, 0 to 1 along each axis, the height is 32 u_a + p u_(a+1) + q u_(a+2) less that value at
/// the lowest corner; the highest corner has the height width(). Every point of the surface in the
/// closed cell has a height from (lower + 1/2) / 256 to (upper + 1/2) / 256 of width().
///
/// source  bounding planes of a node: "Out-of-core real-time haptic interaction on very large
///         models", section 3; their use to tell sides is our own
struct CellSlab {
  static constexpr int kSteps = 32;  ///< steps of a slope in 1
  static constexpr std::uint8_t kNoLower = 0, kNoUpper = 255;

  std::uint16_t direction = make_direction(0, 0, 0);  ///< axis a, 32 + p, 32 + q: 2, 7, 7 bits
  std::uint8_t lower = kNoLower;
  std::uint8_t upper = kNoUpper;

  /// axis  a, 0 to 2
  /// p, q  slopes, -32 to 32
  static constexpr std::uint16_t make_direction(unsigned axis, int p, int q) {
    return static_cast<std::uint16_t>(axis | static_cast<unsigned>(p + kSteps) << 2 |
                                      static_cast<unsigned>(q + kSteps) << 9);
  }
  constexpr unsigned axis() const { return direction & 3; }
  constexpr int p() const { return static_cast<int>(direction >> 2 & 127) - kSteps; }
  constexpr int q() const { return static_cast<int>(direction >> 9) - kSteps; }
  constexpr bool direction_is_valid() const { return axis() < 3 && p() <= kSteps && q() <= kSteps; }
  constexpr bool has_plane() const { return lower != kNoLower || upper != kNoUpper; }
  constexpr bool operator==(const CellSlab&) const = default;

  /// Returns the position of a point in a cell of level `level` whose least corner is `lower`. It
  /// is from 0 to 1 along each axis; where the cell's sides are rounded, the upper end may differ.
  static Point position_in(const Point& point, const Point& lower, unsigned level) {
    return (point - lower) * (0.5 * static_cast<double>(1U << level));
  }
  constexpr int width() const { return kSteps + std::abs(p()) + std::abs(q()); }
  /// Returns the height of the position `u`; right within 2^-40 where `u` is below 256.
  double height(const Point& u) const {
    const unsigned a = axis();
    const int lowest = std::min(p(), 0) + std::min(q(), 0);
    return kSteps * u[a] + (p() * u[a == 2 ? 0 : a + 1] + q() * u[a == 0 ? 2 : a - 1]) - lowest;
  }
  /// Returns which plane a height is beyond: 1 the upper, -1 the lower, 0 neither.
  int side_of(double height) const {
    if (upper != kNoUpper && 256 * height >= (upper + 1) * width()) return 1;
    if (lower != kNoLower && 256 * height <= lower * width()) return -1;
    return 0;
  }
  /// Returns the cell's highest corner; its bits are as in GridCell::child(). The lowest corner is
  /// diagonal to it.
  constexpr unsigned highest_corner() const {
    const unsigned a = axis();
    return 1U << a | static_cast<unsigned>(p() >= 0) << (a + 1) % 3 |
           static_cast<unsigned>(q() >= 0) << (a + 2) % 3;
  }

  static constexpr unsigned kNoCorner = 8;
  /// Returns the corner that lies beyond the same plane as the position `u`, or kNoCorner if `u` is
  /// beyond neither plane.
  unsigned corner_beyond(const Point& u) const {
    const int side = side_of(height(u));
    if (side == 0) return kNoCorner;
    return side > 0 ? highest_corner() : 7 - highest_corner();
  }

  /// Packed form, as frames store it.
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
