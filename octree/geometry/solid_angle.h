#pragma once

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// A triangle's share of the winding number of a point: the solid angle under
/// which it is seen, over 4 pi; positive where it is seen from behind.
struct WindingShare {
  double value = 0;         ///< -1/2 to 1/2
  double error = 0;         ///< the true share is within this of `value`
  bool on_surface = false;  ///< the point is on the triangle: no share, not even near one
};

/// The share of one triangle, certified.
///
/// point     finite, of magnitude at most 2^301, as the corners are.
/// return    an error of 2^-25 at most, and usually below 2^-44, but for points
///           that miss an edge by less than 2^-4000 of a right angle. A triangle
///           without area has no share.
/// threads   any; no allocation.
/// source    the quotient is that of Van Oosterom & Strackee 1983, "The solid
///           angle of a plane triangle"; its error, its sign by an exact
///           predicate and the wider numbers near edges are ours.
WindingShare winding_share(const Point& point, const Triangle& triangle) noexcept;

}  // namespace planetree::octree
