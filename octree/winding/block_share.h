#pragma once

#include "octree/geometry/triangle_distance.h"
#include "octree/page/frame.h"

namespace planetree::octree {

/// The sum of the shares of a block's triangles in the winding number of a point.
struct BlockShare {
  double value = 0;
  double error = 0;     ///< |value - true sum| is at most this
  unsigned unsure = 0;  ///< triangles that the sum leaves out, one bit each; see winding_share()
};

/// Sums up those shares that double suffices for and that are below 1/8: all but those of triangles
/// near the point or in a plane with it.
///
/// point    finite, of magnitude at most 2^301, as are the corners
/// threads  any; no allocation, no lock, no exception
/// source   Each triangle gives a vector whose angle is half of its solid angle, see
///          octree/geometry/angles.cpp. As complex numbers, the product of these has the sum of
///          their angles, so that one arctangent suffices as long as the sum is below pi. The
///          product and its error bound are planetree's own.
BlockShare block_share(const Point& point, const BlockView& block) noexcept;

}  // namespace planetree::octree
