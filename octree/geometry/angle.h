#pragma once

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// The angle of the vector (along, across), across >= 0, from the first axis: 0
/// to pi, right to 2^-50. Not both may be zero; both finite.
///
/// Uses no function of the mathematics library but sqrt: those differ from one
/// processor to the next, and angles reach answers.
double angle_of(double along, double across) noexcept;

/// The angle between two directions, 0 to pi, right to some 4 roundings of pi:
/// 2^-50. Neither may be zero; their lengths do not matter. Exchanging the two
/// changes no bit.
double angle_between(const Point& u, const Point& v) noexcept;

}  // namespace planetree::octree
