#pragma once

#include <array>
#include <cstddef>

#include "octree/geometry/plane.h"

namespace planetree::octree {

/// An axis-aligned box in float, relative to the model's centre.
struct FloatBox {
  std::array<float, 3> lower{};
  std::array<float, 3> upper{};

  std::array<float, 3> centre() const {
    return {(lower[0] + upper[0]) * 0.5f, (lower[1] + upper[1]) * 0.5f,
            (lower[2] + upper[2]) * 0.5f};
  }
  float plane_step() const {
    return octree::plane_step(upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]);
  }
  bool holds(const FloatBox& other) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!(lower[axis] <= other.lower[axis] && other.upper[axis] <= upper[axis])) return false;
    return true;
  }
  float diagonal_squared() const {
    const float dx = upper[0] - lower[0], dy = upper[1] - lower[1], dz = upper[2] - lower[2];
    return dx * dx + dy * dy + dz * dz;
  }
};

}  // namespace planetree::octree
