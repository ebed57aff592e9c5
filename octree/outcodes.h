#pragma once

#include "octree/block_view.h"
#include "octree/triangle_distance.h"

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

}  // namespace planetree::octree
