#pragma once

#include "octree/triangle_distance.h"

namespace planetree::octree {

/// The angle between two directions, 0 to pi, within 1e-15 of the true angle of
/// what is given. Neither may be zero; their lengths do not matter. Exchanging the two changes no
/// bit.
///
/// Uses no function of the mathematics library but sqrt: those differ from one
/// processor to the next, and angles reach answers.
double angle_between(const Point& u, const Point& v) noexcept;

}  // namespace planetree::octree
