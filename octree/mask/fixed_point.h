#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace planetree::octree {

/// Coordinates along an axis as whole steps, 2^kBits of them in a cell of one level. They are
/// computed from the bits of doubles by integers alone, so that the thread's rounding mode and
/// trapped exceptions do not matter.
class FixedPoint {
 public:
  static constexpr unsigned kBits = 30;
  static constexpr std::int64_t kCell = std::int64_t{1} << kBits;
  /// Maximum magnitude of a scale. Beyond it values may be subnormal, whose bits are not read here.
  static constexpr int kMaxScale = 900;
  /// Scale with which every value is out of range.
  static constexpr int kNoScale = 4096;

  FixedPoint() = default;
  /// level  of the cells; those of level 0 have a side of 2
  /// scale  values times 2^scale are in the units of the cells
  FixedPoint(unsigned level, int scale) : shift_(1055 - static_cast<int>(level) - scale) {}

  /// Sum of a value's Digits::shift and of the exponent field in its bits.
  std::int64_t shift() const { return shift_; }

  /// A value as its sign, 0 or -1, its digits, and the number of bits to shift these right to get
  /// steps. The shift is below 0 if the value is out of range: 2^62 steps or more from 0, infinite
  /// or NaN.
  struct Digits {
    std::int64_t sign, digits, shift;
    /// Steps from 0, rounded towards 0. Out of range it has no meaning, but a magnitude below 2^62.
    std::int64_t steps() const {
      const std::int64_t shown = digits >> (std::min(shift, std::int64_t{63}) & 63);
      return (shown ^ sign) - sign;
    }
  };
  Digits digits_of(double value) const {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    // Digits are below 2^62, so that the difference of two coordinates does not overflow.
    const auto digits = static_cast<std::int64_t>(((bits & kDigits) | (kDigits + 1)) << 9);
    const auto sign = static_cast<std::int64_t>(bits) >> 63;
    return {sign, digits, shift_ - static_cast<std::int64_t>(bits >> 52 & 0x7ff)};
  }

 private:
  static constexpr std::uint64_t kDigits = (std::uint64_t{1} << 52) - 1;

  std::int64_t shift_ = 0;
};

}  // namespace planetree::octree
