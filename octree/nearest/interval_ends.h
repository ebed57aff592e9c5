#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"

/// Ends of intervals, rounded outward: each is the result of one addition.
namespace planetree::octree {

inline double lower_end(double value) {
  return std::max(0.0, value - std::fabs(value) * kEndRounding);
}
inline double upper_end(double value) {
  return value + value * kEndRounding + std::numeric_limits<double>::min();
}

}  // namespace planetree::octree
