#pragma once

#include <array>
#include <cstdint>

#include "octree/geometry/triangle_distance.h"
#include "octree/page/block_view.h"

namespace planetree::octree {

/// Tells the triangles of blocks apart from a box by the sides of it that their vertices are
/// beyond, one bit a side, as in Cohen-Sutherland clipping. A vertex nearer to a side than
/// float can tell may be taken for one that is not beyond it.
class Outcodes {
 public:
  /// lower, upper  of the box, model frame.
  Outcodes(const Point& lower, const Point& upper) noexcept;

  /// The triangles with a corner in the box, a bit each.
  unsigned with_corner_within(const BlockView& block) const noexcept;

 private:
  const Point lower_, upper_;
  float float_lower_[3], float_upper_[3];  // outward
};

/// Tells which octants of a box the triangles of blocks are near. A vertex nearer to a side, or to
/// the middle, than float can tell may be taken for one on either side.
class OctantCodes {
 public:
  /// middle  the octants' common corner.
  OctantCodes(const Point& lower, const Point& middle, const Point& upper) noexcept;

  struct Met {
    unsigned with_vertex = 0;                 ///< the octants that vertices are in
    std::uint8_t by_box[kMaxBlockTriangles];  ///< of each triangle: those that its box meets
  };
  Met met_by(const BlockView& block) const noexcept;

  /// Octants by outcodes about the middle: two bits an axis, below it and above it.
  static constexpr auto kOctants = [] {
    constexpr std::array<unsigned, 3> kUpper = {0xaa, 0xcc, 0xf0};
    std::array<std::uint8_t, 64> octants{};
    for (unsigned code = 0; code < 64; ++code) {
      unsigned left = 0xff;
      for (unsigned axis = 0; axis < 3; ++axis) {
        if ((code >> 2 * axis & 1) != 0) left &= ~kUpper[axis];
        if ((code >> 2 * axis & 2) != 0) left &= kUpper[axis];
      }
      octants[code] = static_cast<std::uint8_t>(left);
    }
    return octants;
  }();

 private:
  unsigned code(const Point& greatest, const Point& least) const;

  const Point box_[2], middle_;
  float float_box_[2][3];     // outward
  float float_middle_[2][3];  // about it
};

}  // namespace planetree::octree
