#pragma once

#include <cstdint>
#include <limits>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "octree/geometry/double_parts.h"
#include "octree/geometry/vector3.h"

/// Numbers wider than Quad, and the conversion of doubles to them.
namespace planetree::octree {

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
