#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

/// Bounds of one child as a node stores them: a box in 255ths of the node's own decoded box, and
/// a disc relative to the child's decoded box. The disc is a bounding plane, a unit normal in 32
/// bits with offsets in 16 bits, and a radius. The decoded bounds are what counts: the builder
/// widens the stored ones until the decoded ones enclose the surface. Builder, reader and verifier
/// all decode with the functions below, so that they see the same bounds.
namespace planetree::octree {

/// A direction on the octahedron, 16 bits for each of its two coordinates.
///
/// source  Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit
///         Vectors", method "oct"
struct PackedNormal {
  std::int16_t u = 0, v = 0;
};

inline constexpr float kNormalSteps = 32767.0f;

/// Returns the decoded direction; its length is 1 within 4 units of 2^-24.
inline std::array<float, 3> unpack_normal(PackedNormal packed) {
  float x = std::max(static_cast<float>(packed.u) / kNormalSteps, -1.0f);
  float y = std::max(static_cast<float>(packed.v) / kNormalSteps, -1.0f);
  const float z = 1.0f - std::fabs(x) - std::fabs(y);
  if (z < 0) {
    const float fold_x = 1.0f - std::fabs(y);
    const float fold_y = 1.0f - std::fabs(x);
    x = x < 0 ? -fold_x : fold_x;
    y = y < 0 ? -fold_y : fold_y;
  }
  const float length = std::sqrt(x * x + y * y + z * z);
  return {x / length, y / length, z / length};
}

/// Returns the packed direction nearest to (x, y, z), which is finite and not zero.
inline PackedNormal pack_normal(double x, double y, double z) {
  const double sum = std::fabs(x) + std::fabs(y) + std::fabs(z);
  double u = x / sum;
  double v = y / sum;
  if (z < 0) {
    const double fold_u = 1.0 - std::fabs(v);
    const double fold_v = 1.0 - std::fabs(u);
    u = u < 0 ? -fold_u : fold_u;
    v = v < 0 ? -fold_v : fold_v;
  }
  const auto step = [](double value) {
    const double scaled = value * 32767.0;
    const double rounded = scaled < 0 ? scaled - 0.5 : scaled + 0.5;
    return static_cast<std::int16_t>(std::clamp(rounded, -32767.0, 32767.0));
  };
  return {step(u), step(v)};
}

/// Returns the length of one step of a plane offset or a radius, for a child whose box has edges of
/// these lengths. 16 bits cover a whole diagonal, because the centre of a box only a few ulps large
/// may be rounded to one of its sides.
inline float plane_step(float dx, float dy, float dz) {
  return std::sqrt(dx * dx + dy * dy + dz * dz) * (1.0f / 32000.0f);
}

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
