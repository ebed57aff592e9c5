#pragma once

#include <array>
#include <cstdint>

#include "octree/geometry/float_box.h"
#include "octree/geometry/plane.h"

/// Bounds of one child as a node stores them: a box in 255ths of the node's own decoded box, and
/// the disc relative to the child's decoded box. Builder, reader and verifier all decode with the
/// functions below, so that they see the same bounds.
namespace planetree::octree {

struct PackedChild {
  std::array<std::uint8_t, 3> lower{};  ///< steps up from the node's lower sides
  std::array<std::uint8_t, 3> upper{};  ///< steps down from the node's upper sides
  PackedNormal normal;
  std::int16_t slab_lower = 0;
  std::int16_t slab_upper = 0;
  std::uint16_t radius = 0;
};

/// Steps from one side of a box to the other. A child's lower and upper counts add up to at most
/// this on each axis.
inline constexpr int kBoxSteps = 255;

/// Returns the length of one step of the children's sides along one axis.
inline float box_step(float lower, float upper) { return (upper - lower) * (1.0f / kBoxSteps); }

/// Returns the box of a child from the steps of its sides within its parent's box.
inline FloatBox unpack_box(const FloatBox& parent, const std::array<std::uint8_t, 3>& lower,
                           const std::array<std::uint8_t, 3>& upper) {
  FloatBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float step = box_step(parent.lower[axis], parent.upper[axis]);
    box.lower[axis] = parent.lower[axis] + static_cast<float>(lower[axis]) * step;
    box.upper[axis] = parent.upper[axis] - static_cast<float>(upper[axis]) * step;
  }
  return box;
}
inline FloatBox unpack_box(const FloatBox& parent, const PackedChild& child) {
  return unpack_box(parent, child.lower, child.upper);
}

/// A decoded disc, relative to the centre of its box: a slab and the radius of the cylinder that
/// cuts it off.
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
