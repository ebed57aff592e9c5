#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "octree/plane.h"

/// What a node knows of one child, as stored: a box in 256ths of the node's
/// own decoded box, and the bounding planes relative to the child's decoded
/// box. Decoding is the one truth that builder, reader and verifier share.
namespace planetree::octree {

/// An axis-aligned box relative to the model's centre.
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

struct PackedChild {
  std::array<std::uint8_t, 3> lower{};
  std::array<std::uint8_t, 3> upper{};
  PackedNormal normal;
  std::int16_t slab_lower = 0;
  std::int16_t slab_upper = 0;
  std::uint16_t radius = 0;
};

/// Coordinate `steps` 255ths of the way from `lower` to `upper`, never beyond.
inline float unpack_coordinate(float lower, float upper, std::uint8_t steps) {
  const float step = (upper - lower) * (1.0f / 255.0f);
  return std::min(lower + static_cast<float>(steps) * step, upper);
}

inline FloatBox unpack_box(const FloatBox& parent, const PackedChild& child) {
  FloatBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = unpack_coordinate(parent.lower[axis], parent.upper[axis], child.lower[axis]);
    // 255 means the parent's own side: 255 steps may round below it.
    box.upper[axis] =
        child.upper[axis] == 255
            ? parent.upper[axis]
            : unpack_coordinate(parent.lower[axis], parent.upper[axis], child.upper[axis]);
  }
  return box;
}

/// A decoded slab with its tangential extent, about the centre of its box.
struct Disc {
  std::array<float, 3> normal{0, 0, 1};
  float slab_lower = 0;
  float slab_upper = 0;
  float radius = 0;
};

inline Disc unpack_disc(const FloatBox& box, const PackedChild& child) {
  const float step = box.plane_step();
  return {unpack_normal(child.normal), static_cast<float>(child.slab_lower) * step,
          static_cast<float>(child.slab_upper) * step, static_cast<float>(child.radius) * step};
}

}  // namespace planetree::octree
