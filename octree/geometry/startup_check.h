#pragma once

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// The predicates that a self test asks: those of octree/geometry/predicates.h, or others
/// to see that it finds them wrong.
struct TestedPredicates {
  int (*orientation)(const Point& a, const Point& b, const Point& c, const Point& d) noexcept;
  int (*normal_sign)(const Point& a, const Point& b, const Point& c, unsigned axis) noexcept;
  bool (*lies_on)(const Point& point, const Triangle& triangle) noexcept;

  static TestedPredicates ours() noexcept;
};

/// Queries the arithmetic of this build, processor and thread, and the predicates,
/// what the answers rest on: single roundings to nearest, no fused operations,
/// no extra digits, subnormal numbers; signs that a filter cannot tell.
///
/// return   null if all is well, else what is wrong, in words.
/// cost     some 20 microseconds; no allocation, no lock.
/// threads  any.
const char* startup_check(const TestedPredicates& predicates = TestedPredicates::ours()) noexcept;

}  // namespace planetree::octree
