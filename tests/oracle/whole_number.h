#pragma once

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "planetree/types.h"

/// Doubles as multiples of one power of two: integers, without any error.
namespace planetree::oracle {

using Integer = boost::multiprecision::cpp_int;

/// The exponent e of the last bit of a double: value = integer * 2^e.
inline int last_exponent(double value) {
  if (value == 0) return std::numeric_limits<int>::max();
  int exponent = 0;
  std::frexp(value, &exponent);
  return std::max(exponent - 53, -1074);
}

inline int last_exponent(const Vec3& p) {
  return std::min({last_exponent(p.x), last_exponent(p.y), last_exponent(p.z)});
}

/// value / 2^exponent, which must be an integer.
inline Integer to_integer(double value, int exponent) {
  if (value == 0) return 0;
  int top = 0;
  const double fraction = std::frexp(value, &top);
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(fraction, 53));
  const int shift = top - 53 - exponent;
  const Integer integer = mantissa;
  if (shift >= 0) return integer << static_cast<unsigned>(shift);
  return mantissa < 0 ? Integer(-(Integer(-integer) >> static_cast<unsigned>(-shift)))
                      : Integer(integer >> static_cast<unsigned>(-shift));
}

}  // namespace planetree::oracle
