#pragma once

#include "octree/geometry/triangle_distance.h"

/// Exact versions of the predicates of octree/geometry/predicates.h, for arguments that its filter
/// in double cannot decide. They return the same signs and compute in integers: no allocation, no
/// rounding, no dependence on the thread's floating-point mode. A call takes about a microsecond,
/// the filter nanoseconds.
namespace planetree::octree {

int exact_orientation(const Point& a, const Point& b, const Point& c, const Point& d) noexcept;
int exact_normal_sign(const Point& a, const Point& b, const Point& c, unsigned axis) noexcept;

}  // namespace planetree::octree
