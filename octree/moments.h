#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "octree/frame.h"
#include "octree/triangle_distance.h"

/// What a node of an open model knows of each child besides its bounds: enough
/// to tell the child's share of a far point's winding number, and how wrong
/// that may be (Barill et al. 2018, "Fast winding numbers for soups and
/// clouds", of whose moments these are the first; the error bound is ours).
namespace planetree::octree {

/// A float without its lower 16 bits: 8 bits of precision, positive.
using ShortFloat = std::uint16_t;
inline constexpr ShortFloat kLeastShortFloat = 0x0080;     ///< 2^-126
inline constexpr ShortFloat kGreatestShortFloat = 0x7f7f;  ///< below 2^128

constexpr float unpack_short(ShortFloat packed) {
  return std::bit_cast<float>(std::uint32_t{packed} << 16);
}

/// The least short float that is not below `value`, which is at least 0.
constexpr ShortFloat pack_short_above(double value) {
  constexpr auto greatest = static_cast<double>(unpack_short(kGreatestShortFloat));
  if (!(value < greatest)) return kGreatestShortFloat;
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  auto packed = static_cast<ShortFloat>(bits >> 16);
  if (packed < kLeastShortFloat) packed = kLeastShortFloat;
  // The next in size is the next in bits.
  return static_cast<double>(unpack_short(packed)) < value ? static_cast<ShortFloat>(packed + 1)
                                                           : packed;
}

/// The moments of one child's triangles; model frame.
struct Moments {
  float vector[3];    ///< sum of the halves of (b - a) x (c - a), to 2^-22 of `area`
  ShortFloat area;    ///< at least the sum of their areas
  ShortFloat spread;  ///< at least the integral of the distance from the box's centre over them
};
static_assert(sizeof(Moments) == 16);

/// Those of all children, field by field, as the serving layout has them
/// behind a node. Absent children have zeros.
struct alignas(kSlotBytes) NodeMoments {
  float vector[3][kFanOut];
  ShortFloat area[kFanOut];
  ShortFloat spread[kFanOut];

  static const NodeMoments& of(const Node& node) {
    return *reinterpret_cast<const NodeMoments*>(&node + 1);
  }
  Moments child(std::size_t at) const {
    return {{vector[0][at], vector[1][at], vector[2][at]}, area[at], spread[at]};
  }
  void set(std::size_t at, const Moments& moments) {
    for (std::size_t axis = 0; axis < 3; ++axis) vector[axis][at] = moments.vector[axis];
    area[at] = moments.area;
    spread[at] = moments.spread;
  }
};
static_assert(sizeof(NodeMoments) == kMomentSlots * kSlotBytes);

/// How much the vector may err, as a share of the area.
inline constexpr double kVectorError = 0x1p-22;

}  // namespace planetree::octree
