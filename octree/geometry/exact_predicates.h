#pragma once

#include "octree/geometry/triangle_distance.h"

/// What octree/geometry/predicates.h asks where double cannot tell: the same signs, in
/// whole numbers. No allocation, no rounding, no care for the floating-point
/// mode of the thread; a microsecond rather than nanoseconds.
namespace planetree::octree {

int exact_orientation(const Point& a, const Point& b, const Point& c, const Point& d) noexcept;
int exact_normal_sign(const Point& a, const Point& b, const Point& c, unsigned axis) noexcept;

}  // namespace planetree::octree
