#pragma once

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

class WorkLimit;

/// Returns the angle between the first axis and the vector (along, across).
///
/// along   finite
/// across  finite, >= 0; not both may be zero
/// return  0 to pi, right to 2^-50
///
/// Calls no function of the mathematics library but sqrt: the others differ between processors, and
/// angles reach answers.
double angle_of(double along, double across) noexcept;

/// Returns the angle between two directions.
///
/// u, v    finite, of any length but zero
/// return  0 to pi, right to about 4 roundings of pi, 2^-50; angle_between(v, u) has the same bits
double angle_between(const Point& u, const Point& v) noexcept;

/// A triangle's share of the winding number of a point: the solid angle that the triangle covers as
/// seen from the point, over 4 pi. It is positive if the point is behind the triangle.
struct WindingShare {
  double value = 0;         ///< -1/2 to 1/2
  double error = 0;         ///< |value - true share| is at most this
  bool on_surface = false;  ///< the point is on the triangle, where no share is defined
};

/// Returns the certified share of one triangle.
///
/// point    finite, of magnitude at most 2^301, as are the corners
/// return   a share with an error of at most 2^-25, usually below 2^-44; larger only for points
///          that miss an edge by less than 2^-4000 of a right angle. A triangle without area has
///          the share 0.
/// limit    charged for what takes more than double; the caller charges the rest. Null: no limit.
///          If the limit refuses, the error may be up to 1/2, and on_surface false on the triangle.
/// threads  any; no allocation
/// source   the quotient is from Van Oosterom & Strackee 1983, "The solid angle of a plane
///          triangle". Its error bound, its sign by an exact predicate and the wider numbers near
///          edges are our own.
WindingShare winding_share(const Point& point, const Triangle& triangle,
                           WorkLimit* limit = nullptr) noexcept;

}  // namespace planetree::octree
