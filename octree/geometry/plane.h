#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

/// Storage of bounding planes: a unit normal in 32 bits and offsets in 16 bits, relative to the box
/// they belong to. The decoded planes are what counts: the builder widens offsets until the decoded
/// planes enclose the surface.
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

}  // namespace planetree::octree
