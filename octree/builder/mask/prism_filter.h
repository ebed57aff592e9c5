#pragma once

#include <array>

#include "octree/geometry/triangle_distance.h"
#include "octree/page/frame.h"

namespace planetree::octree {

/// A prism, in a frame of its own: there a point x has the coordinates rotated * (x - origin).
struct FloatPrism {
  std::array<std::array<float, 3>, 3> rotated;  ///< rows are orthonormal but for rounding
  std::array<float, 3> lower, upper;  ///< the last components are the ends; upper is in front
  float clear = 0;                    ///< minimum distance from the ends of what is between them
  std::array<float, 2> middle;        ///< where the middle line goes from end to end
};

/// Sets of a block's triangles, one bit each.
struct PrismTriangles {
  unsigned met = 0;     ///< all whose boxes, in the prism's frame, meet it; and some others
  unsigned rising = 0;  ///< certainly between the ends, with normals that HeightField requires
  unsigned middle = 0;  ///< all that the middle line may go through, and some others
};

/// Classifies a block's triangles against a prism, in float.
///
/// origin   origin of the prism's frame.
/// threads  any; the same bits on every instruction set.
PrismTriangles classify_triangles(const BlockView& block, const FloatPrism& prism,
                                  const Point& origin) noexcept;

}  // namespace planetree::octree
