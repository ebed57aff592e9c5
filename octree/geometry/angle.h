#pragma once

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

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

}  // namespace planetree::octree
