#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "octree/vector3.h"

/// Numbers wider than Quad, and doubles made wide bit by bit.
namespace planetree::octree {

/// 4096 bits, on the stack: enough for directions to tell a point from a line
/// that misses it by the least of doubles.
using Widest = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<4096, boost::multiprecision::digit_base_2, void,
                                         std::int32_t>,
    boost::multiprecision::et_off>;

template <class Scalar>
inline constexpr int kBits = std::numeric_limits<Scalar>::digits;

/// `value`, which is finite, without any error. Taken from its bits: a thread
/// may have been told to take subnormal numbers for zero.
template <class Scalar>
Scalar wide(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const int biased = static_cast<int>(bits >> 52 & 0x7ff);
  auto mantissa = static_cast<std::int64_t>(bits & ((std::uint64_t{1} << 52) - 1));
  if (biased != 0) mantissa |= std::int64_t{1} << 52;
  const Scalar magnitude = ldexp(Scalar(mantissa), (biased == 0 ? 1 : biased) - 1075);
  return (bits >> 63) != 0 ? Scalar(-magnitude) : magnitude;
}

}  // namespace planetree::octree
