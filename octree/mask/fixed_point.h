#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace planetree::octree {

/// Indices along an axis in whole steps, so many to a cell of one level: told of the bits of
/// doubles alone, so that it does not matter how the thread rounds or what it has trapped.
class FixedPoint {
 public:
  static constexpr unsigned kBits = 30;
  static constexpr std::int64_t kCell = std::int64_t{1} << kBits;
  /// Scales beyond these are those of subnormal numbers, of which no bits are told here.
  static constexpr int kMaxScale = 900;
  /// With which nothing has a place.
  static constexpr int kNoScale = 4096;

  FixedPoint() = default;
  /// Of the cells of a level, where those of level 0 have a side of 2, and of values that are
  /// 2^-scale of theirs.
  FixedPoint(unsigned level, int scale) : shift_(1055 - static_cast<int>(level) - scale) {}

  /// Digits::shift of a value, and its exponent as it is in its bits.
  std::int64_t shift() const { return shift_; }

  /// A value as its sign, 0 or -1, so many digits, and how far to the right they are to be shifted:
  /// below 0 if the place is 2^62 steps away or farther, or the value is no number.
  struct Digits {
    std::int64_t sign, digits, shift;
    /// Steps from 0, less than one too few; anything below 2^62 either way of a shift below 0.
    std::int64_t steps() const {
      const std::int64_t shown = digits >> (std::min(shift, std::int64_t{63}) & 63);
      return (shown ^ sign) - sign;
    }
  };
  Digits digits_of(double value) const {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    // The greatest is below 2^62: so places may be subtracted from each other.
    const auto digits = static_cast<std::int64_t>(((bits & kDigits) | (kDigits + 1)) << 9);
    const auto sign = static_cast<std::int64_t>(bits) >> 63;
    return {sign, digits, shift_ - static_cast<std::int64_t>(bits >> 52 & 0x7ff)};
  }

 private:
  static constexpr std::uint64_t kDigits = (std::uint64_t{1} << 52) - 1;

  std::int64_t shift_ = 0;
};

}  // namespace planetree::octree
