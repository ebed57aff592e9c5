#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "octree/geometry/triangle_distance.h"

/// Numbers wider than double, for where double loses too many bits, and vectors of three numbers of
/// any type. Eigen's vectors hold only doubles in this project.
namespace planetree::octree {

/// A finite double as mantissa * 2^(exponent - 1074). The parts are read from its bits because the
/// thread's mode may treat subnormal numbers as zero.
struct DoubleParts {
  std::int64_t mantissa;
  int exponent;

  explicit DoubleParts(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const int biased = static_cast<int>(bits >> 52 & 0x7ff);
    mantissa = static_cast<std::int64_t>(bits & ((std::uint64_t{1} << 52) - 1));
    if (biased != 0) mantissa |= std::int64_t{1} << 52;
    if ((bits >> 63) != 0) mantissa = -mantissa;
    exponent = std::max(biased, 1) - 1;
  }
};

/// Floating-point number with a mantissa of 113 bits.
using Quad = boost::multiprecision::cpp_bin_float_quad;

template <class Scalar>
using Vector3 = std::array<Scalar, 3>;

template <class Scalar>
Vector3<Scalar> cross(const Vector3<Scalar>& a, const Vector3<Scalar>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class Scalar>
Scalar dot(const Vector3<Scalar>& a, const Vector3<Scalar>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Scalar>
Vector3<Scalar> difference(const Point& a, const Point& b) {
  return {Scalar(a.x()) - Scalar(b.x()), Scalar(a.y()) - Scalar(b.y()),
          Scalar(a.z()) - Scalar(b.z())};
}

/// Floating-point number with a mantissa of 4096 bits, stored without allocation. Unit vectors of
/// this precision tell a point from a line that it misses by the least positive double.
using Widest = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<4096, boost::multiprecision::digit_base_2, void,
                                         std::int32_t>,
    boost::multiprecision::et_off>;

template <class Scalar>
inline constexpr int kBits = std::numeric_limits<Scalar>::digits;

/// Converts `value`, which is finite, without error.
template <class Scalar>
Scalar wide(double value) {
  const DoubleParts parts(value);
  return ldexp(Scalar(parts.mantissa), parts.exponent - 1074);
}

}  // namespace planetree::octree
