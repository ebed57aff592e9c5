#pragma once

#include <array>

#include "octree/geometry/triangle_distance.h"
#include "octree/page/block_view.h"

namespace planetree::octree {

/// An upright box, in a frame of its own: the point x is at turned * (x - origin) there.
struct FloatPrism {
  std::array<std::array<float, 3>, 3> rotated;  ///< orthonormal rows to rounding
  std::array<float, 3> lower, upper;            ///< the last: its ends, the upper one in front
  float clear = 0;                              ///< what is between the ends is so far from them
  std::array<float, 2> middle;                  ///< where a line goes from end to end
};

/// A bit for each triangle of a block.
struct PrismTriangles {
  unsigned met = 0;     ///< all whose boxes, in the prism's frame, meet it; some others
  unsigned rising = 0;  ///< certainly between the ends, of normals as HeightField asks for
  unsigned middle = 0;  ///< all that the line may go through; some others
};

/// What float can tell of a block's triangles and a prism.
///
/// origin  the prism's.
/// threads any; the same bits on every instruction set.
PrismTriangles look_at_triangles(const BlockView& block, const FloatPrism& prism,
                                 const Point& origin) noexcept;

}  // namespace planetree::octree
