#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

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

}  // namespace planetree::octree
