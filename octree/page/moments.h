#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "octree/geometry/child_bounds.h"
#include "octree/geometry/triangle_distance.h"
#include "octree/page/frame.h"

/// What a node of an open model knows of each child besides its bounds: enough
/// to tell the child's share of a far point's winding number, and how wrong
/// that may be (Barill et al. 2018, "Fast winding numbers for soups and
/// clouds"; what is stored of the moments and how wrong they may be is ours).
namespace planetree::octree {

/// A float without its lower 16 bits: 8 bits of precision, positive.
using ShortFloat = std::uint16_t;
inline constexpr ShortFloat kMinShortFloat = 0x0080;       ///< 2^-126
inline constexpr ShortFloat kGreatestShortFloat = 0x7f7f;  ///< below 2^128

constexpr float unpack_short(ShortFloat packed) {
  return std::bit_cast<float>(std::uint32_t{packed} << 16);
}

/// The least short float that is not below `value`, which is at least 0.
constexpr ShortFloat pack_short_above(double value) {
  constexpr auto kGreatest = static_cast<double>(unpack_short(kGreatestShortFloat));
  if (!(value < kGreatest)) return kGreatestShortFloat;
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  auto packed = static_cast<ShortFloat>(bits >> 16);
  if (packed < kMinShortFloat) packed = kMinShortFloat;
  // The next in size is the next in bits.
  return static_cast<double>(unpack_short(packed)) < value ? static_cast<ShortFloat>(packed + 1)
                                                           : packed;
}

/// What the moments of a child with that box are about.
inline Point centre_of(const FloatBox& box) {
  const std::array<float, 3> centre = box.centre();
  return {static_cast<double>(centre[0]), static_cast<double>(centre[1]),
          static_cast<double>(centre[2])};
}

/// The moments of one child's triangles as they are stored, about the centre of
/// the child's decoded box; model frame. With x relative to that centre, n the
/// normal of length 1 and integrals over the triangles:
struct Moments {
  std::array<std::int16_t, 3> vector{};  ///< integral of n, in vector_unit()
  std::array<std::int8_t, 5> first{};    ///< of x n^T, made symmetric and free of trace: xx, yy,
                                         ///< xy, yz, zx in first_unit()
  ShortFloat area = 0;                   ///< at least the integral of 1
  ShortFloat second = 0;                 ///< at least the integral of |x|^2

  /// A vector is no longer than the area, and a first moment, by Cauchy and
  /// Schwarz, no larger than the root of area times second moment.
  double vector_unit() const { return wide(area) * (1.0 / kVectorSteps); }
  double first_unit() const { return std::sqrt(wide(area) * wide(second)) * (1.0 / kFirstSteps); }
  static double wide(ShortFloat packed) { return static_cast<double>(unpack_short(packed)); }

  static constexpr int kVectorSteps = 32767;
  static constexpr int kFirstSteps = 127;
};

/// How far a stored vector may be off, as a share of the area: half a step an
/// axis and a little.
inline constexpr double kVectorError = 0x1p-15;
/// How far a stored first moment may be off as a matrix, by the root of the sum
/// of its squares, in units: half a step each, a whole one for zz, and a little.
inline constexpr double kFirstError = 1.75;

/// The moments of all children, field by field, as the serving layout has them
/// behind a node. Absent children have zeros.
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
