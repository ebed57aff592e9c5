#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "octree/geometry/child_bounds.h"
#include "octree/geometry/triangle_distance.h"
#include "octree/page/frame.h"

/// Multipole moments that a node stores of each child if the model is not watertight. They suffice
/// to bound the child's share of the winding number of a far point.
///
/// source  Barill et al. 2018, "Fast winding numbers for soups and clouds"; the stored form and its
///         error bounds are our own
namespace planetree::octree {

/// A positive float without its lower 16 bits: 8 bits of precision.
using ShortFloat = std::uint16_t;
inline constexpr ShortFloat kMinShortFloat = 0x0080;  ///< 2^-126
/// Below 2^128. As an area or a second moment it says that no bound is known.
inline constexpr ShortFloat kMaxShortFloat = 0x7f7f;

constexpr float unpack_short(ShortFloat packed) {
  return std::bit_cast<float>(std::uint32_t{packed} << 16);
}

/// Returns the least short float that is not below `value`, which is at least 0.
constexpr ShortFloat pack_short_above(double value) {
  constexpr auto kMaxValue = static_cast<double>(unpack_short(kMaxShortFloat));
  if (!(value < kMaxValue)) return kMaxShortFloat;
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  auto packed = static_cast<ShortFloat>(bits >> 16);
  if (packed < kMinShortFloat) packed = kMinShortFloat;
  // Short floats are ordered as their bits.
  return static_cast<double>(unpack_short(packed)) < value ? static_cast<ShortFloat>(packed + 1)
                                                           : packed;
}

/// Returns the point that the moments of a child with this box are relative to.
inline Point centre_of(const FloatBox& box) {
  const std::array<float, 3> centre = box.centre();
  return {static_cast<double>(centre[0]), static_cast<double>(centre[1]),
          static_cast<double>(centre[2])};
}

/// Stored moments of one child's triangles, in the model frame, about the centre of the child's
/// decoded box. Below, x is relative to that centre, n is the unit normal, and integrals are over
/// the triangles.
struct Moments {
  std::array<std::int16_t, 3> vector{};  ///< dipole: integral of n, in dipole_unit()
  std::array<std::int8_t, 5> first{};    ///< quadrupole: integral of x n^T, symmetric part without
                                         ///< trace: xx, yy, xy, yz, zx in quadrupole_unit()
  ShortFloat area = 0;                   ///< area, rounded up
  ShortFloat second = 0;                 ///< second moment, the integral of |x|^2, rounded up

  /// Units of the stored integers. A dipole is at most as long as the area. A quadrupole is, by
  /// Cauchy and Schwarz, at most the root of area times second moment.
  bool are_known() const { return area < kMaxShortFloat && second < kMaxShortFloat; }
  double dipole_unit() const { return wide(area) * (1.0 / kDipoleSteps); }
  double quadrupole_unit() const {
    return std::sqrt(wide(area) * wide(second)) * (1.0 / kQuadrupoleSteps);
  }
  static double wide(ShortFloat packed) { return static_cast<double>(unpack_short(packed)); }

  static constexpr int kDipoleSteps = 32767;
  static constexpr int kQuadrupoleSteps = 127;
};

/// Maximum error of a stored dipole, as a share of the area: half a step on each axis, and some
/// slack.
inline constexpr double kDipoleError = 0x1p-15;
/// Maximum error of a stored quadrupole, as the root of the sum of the squared entries of a matrix,
/// in units: half a step an entry, a whole one for zz, and some slack.
inline constexpr double kQuadrupoleError = 1.75;

/// The moments of all children, field by field. In the serving layout they follow the node. Absent
/// children have zeros.
struct alignas(kSlotBytes) NodeMoments {
  std::int16_t vector[3][kFanOut];
  ShortFloat area[kFanOut];
  ShortFloat second[kFanOut];
  std::int8_t first[5][kFanOut];
  std::uint8_t reserved[8];

  static const NodeMoments& of(const Node& node) {
    return *reinterpret_cast<const NodeMoments*>(&node + 1);
  }
  Moments child(std::size_t at) const {
    Moments moments;
    for (std::size_t i = 0; i < 3; ++i) moments.vector[i] = vector[i][at];
    for (std::size_t i = 0; i < 5; ++i) moments.first[i] = first[i][at];
    moments.area = area[at];
    moments.second = second[at];
    return moments;
  }
  void set(std::size_t at, const Moments& moments) {
    for (std::size_t i = 0; i < 3; ++i) vector[i][at] = moments.vector[i];
    for (std::size_t i = 0; i < 5; ++i) first[i][at] = moments.first[i];
    area[at] = moments.area;
    second[at] = moments.second;
  }
};
static_assert(sizeof(NodeMoments) == kMomentSlots * kSlotBytes);

}  // namespace planetree::octree
