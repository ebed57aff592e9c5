#pragma once

#include <cmath>
#include <limits>

#include "octree/geometry/child_bounds.h"
#include "octree/geometry/triangle_distance.h"

/// Boxes in float that enclose points in double.
namespace planetree::octree {

inline float float_below(double value) {
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) <= value
             ? nearest
             : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}

inline float float_above(double value) {
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) >= value
             ? nearest
             : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

inline FloatBox empty_box() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  return {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
}

/// Extends `box` to a point relative to the model's centre.
inline void extend(FloatBox& box, const Point& point) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double value = point[static_cast<Eigen::Index>(axis)];
    box.lower[axis] = std::min(box.lower[axis], float_below(value));
    box.upper[axis] = std::max(box.upper[axis], float_above(value));
  }
}

inline void extend(FloatBox& box, const FloatBox& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lower[axis] = std::min(box.lower[axis], other.lower[axis]);
    box.upper[axis] = std::max(box.upper[axis], other.upper[axis]);
  }
}

/// Half the surface area.
inline float half_area(const FloatBox& box) {
  const float dx = box.upper[0] - box.lower[0];
  const float dy = box.upper[1] - box.lower[1];
  const float dz = box.upper[2] - box.lower[2];
  return dx * dy + dy * dz + dz * dx;
}

}  // namespace planetree::octree
