#pragma once

#include <array>
#include <cstdint>

#include "octree/block_view.h"
#include "octree/frame.h"
#include "octree/triangle_distance.h"

namespace planetree::octree {

/// Which sides of a box the vertices of a block are beyond, one bit a side, as in
/// Cohen-Sutherland clipping. A vertex nearer to a side than float can tell may be taken
/// for one that is not beyond it.
class Outcodes {
 public:
  /// lower, upper  model frame.
  Outcodes(const BlockView& block, const Point& lower, const Point& upper) noexcept;

  /// Whether a triangle's box is apart from the box.
  bool apart(unsigned triangle) const {
    return (code_[corner_[0][triangle]] & code_[corner_[1][triangle]] &
            code_[corner_[2][triangle]]) != 0;
  }
  /// Whether a corner of it is in the box.
  bool has_corner_within(unsigned triangle) const {
    return code_[corner_[0][triangle]] == 0 || code_[corner_[1][triangle]] == 0 ||
           code_[corner_[2][triangle]] == 0;
  }

 private:
  const std::uint8_t (&corner_)[3][kMaxBlockTriangles];
  std::array<std::uint8_t, kMaxBlockVertices> code_;
};

}  // namespace planetree::octree
