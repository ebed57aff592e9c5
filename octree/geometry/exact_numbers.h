#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include <boost/multiprecision/cpp_int.hpp>

#include "octree/geometry/triangle_distance.h"
#include "octree/geometry/wide_numbers.h"
#include "octree/geometry/work_limit.h"
#include "planetree/types.h"

/// Integers that hold differences of coordinates and their determinants without rounding. No
/// allocation, no dependence on the thread's floating-point mode.
namespace planetree::octree {

namespace mp = boost::multiprecision;

/// Integer of fixed size, stored without allocation.
template <unsigned kBits>
using Whole =
    mp::number<mp::cpp_int_backend<kBits, kBits, mp::signed_magnitude, mp::unchecked, void>,
               mp::et_off>;

/// Coordinates are multiples of 2^-1074 and below 2^302; differences of two are below 2^1377 units.
/// A determinant is a sum of six products of three differences: below 2^4134.
using LargeWhole = Whole<4160>;
/// Most coordinates are of similar size. Coordinates below 2^126 have differences below 2^127 and
/// determinants below 2^384; areas of 2^20 corners are below 2^276.
using SmallWhole = Whole<384>;
constexpr int kSmallBits = 126;

/// The unit of some points: the largest power of two that divides all their coordinates.
class CommonUnit {
 public:
  template <std::size_t kCount>
  explicit CommonUnit(const std::array<const Point*, kCount>& points) {
    for (const Point* point : points) add(*point);
  }
  explicit CommonUnit(std::span<const Vec3> points) {
    for (const Vec3& point : points) add({point.x, point.y, point.z});
  }

  /// Returns whether all coordinates are below 2^kSmallBits units.
  bool small() const { return max_ - exponent_ <= kSmallBits - 53; }

  template <class Number>
  std::array<Number, 3> difference(const Point& to, const Point& from) const {
    std::array<Number, 3> result;
    for (unsigned axis = 0; axis < 3; ++axis)
      result[axis] = whole<Number>(to[axis]) - whole<Number>(from[axis]);
    return result;
  }

 private:
  void add(const Point& point) {
    for (const double value : point)
      if (const DoubleParts parts(value); parts.mantissa != 0) {
        exponent_ = std::min(exponent_, parts.exponent);
        max_ = std::max(max_, parts.exponent);
      }
  }
  template <class Number>
  Number whole(double value) const {
    const DoubleParts parts(value);
    Number result = parts.mantissa;
    if (parts.mantissa != 0) result <<= static_cast<unsigned>(parts.exponent - exponent_);
    return result;
  }

  int exponent_ = 2046;
  int max_ = 0;
};

template <class Number>
Number determinant(const std::array<Number, 3>& u, const std::array<Number, 3>& v,
                   const std::array<Number, 3>& w) {
  return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
         u[2] * (v[0] * w[1] - v[1] * w[0]);
}

__extension__ using Int128 = __int128;

inline int sign_of(Int128 value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

/// Units of some points, one for each axis: the sign of a determinant does not depend on the unit
/// of an axis. Points of one patch of a surface take some 26 bits along each axis. Planar patches
/// need many determinants, most of which are 0, so that these are fast.
class AxisUnits {
 public:
  template <std::size_t kCount>
  explicit AxisUnits(const std::array<const Point*, kCount>& points) {
    for (const Point* point : points)
      for (unsigned axis = 0; axis < 3; ++axis)
        if (const DoubleParts parts((*point)[axis]); parts.mantissa != 0) {
          const auto magnitude = static_cast<std::uint64_t>(std::abs(parts.mantissa));
          least_[axis] = std::min(least_[axis], parts.exponent + std::countr_zero(magnitude));
          greatest_[axis] = std::max(greatest_[axis],
                                     parts.exponent + static_cast<int>(std::bit_width(magnitude)));
        }
  }

  /// Returns whether coordinates fit 62 bits, and determinants of their differences 126 bits. A
  /// determinant is a sum of six products of three differences, each below twice a coordinate.
  bool small() const {
    int sum = 0, most = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const int bits = std::max(greatest_[axis] - least_[axis], 0);
      sum += bits;
      most = std::max(most, bits);
    }
    return most <= 62 && sum <= 120;
  }

  /// Returns the difference of two points, each axis in its unit.
  std::array<Int128, 3> difference(const Point& to, const Point& from) const {
    std::array<Int128, 3> result;
    for (unsigned axis = 0; axis < 3; ++axis)
      result[axis] = Int128{whole(to[axis], axis)} - whole(from[axis], axis);
    return result;
  }

 private:
  std::int64_t whole(double value, unsigned axis) const {
    const DoubleParts parts(value);
    if (parts.mantissa == 0) return 0;
    const int shift = parts.exponent - least_[axis];
    // The bits shifted out are 0.
    return shift < 0 ? parts.mantissa >> -shift : parts.mantissa * (std::int64_t{1} << shift);
  }

  std::array<int, 3> least_{4096, 4096, 4096}, greatest_{0, 0, 0};
};

/// Charges a sign, if there is a limit. Returns false if the limit refuses.
inline bool may_take(WorkLimit* limit, std::uint64_t units) {
  return !limit || limit->try_take(units);
}
inline std::uint64_t units_of(const CommonUnit& unit) {
  return unit.small() ? WorkUnits::kMediumSign : WorkUnits::kLargeSign;
}

}  // namespace planetree::octree
