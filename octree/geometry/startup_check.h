#pragma once

#include "octree/geometry/triangle_distance.h"
#include "planetree/error.h"

namespace planetree::octree {

/// The predicates that startup_check() tests: those of octree/geometry/predicates.h, or faulty ones
/// from a test of startup_check() itself.
struct TestedPredicates {
  int (*orientation)(const Point& a, const Point& b, const Point& c, const Point& d) noexcept;
  int (*normal_sign)(const Point& a, const Point& b, const Point& c, unsigned axis) noexcept;
  bool (*lies_on)(const Point& point, const Triangle& triangle) noexcept;

  static TestedPredicates library() noexcept;
};

/// Checks that the arithmetic of this build, processor and thread, and the predicates, meet what
/// the answers rest on: single roundings to nearest, no fused operations, no extra digits,
/// subnormal numbers, and exact signs where the filter in double cannot decide.
///
/// return   null if all is well, else a description of the fault
/// cost     about 20 microseconds; no allocation, no lock
/// threads  any
const char* startup_check(
    const TestedPredicates& predicates = TestedPredicates::library()) noexcept;

/// errors  kUnsupported: startup_check() found a fault.
Result<void> check_arithmetic() noexcept;

}  // namespace planetree::octree
