#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "octree/mask/side_grid_cells.h"

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

/// Finds points among the cells of a SideGrid. The grid has a rim of cells around the model's box.
/// Points farther out count as points in the rim.
struct GridCoordinates {
  static constexpr std::uint32_t kRim = 1;  ///< cells of the rim on each side of the box
  /// Bits of a step that select the octant of a cell, and the octant of that octant. The latter is
  /// the smallest part that is found.
  static constexpr unsigned kOctantBits = FixedPoint::kBits - 1, kMinBits = kOctantBits - 1;
  static constexpr std::int64_t kMin = std::int64_t{1} << kMinBits;  ///< steps along such a part
  /// A coordinate in the rim, in the middle of a smallest part and so away from all faces.
  static constexpr std::int64_t kRimMiddle = FixedPoint::kCell / 2 + kMin / 2;

  /// One value for each axis, and one more to fill a vector.
  template <class T>
  using Axes = std::array<T, 4>;

  /// Steps along each axis, counted from `first`. The bits below kMin may be wrong.
  struct Position {
    std::array<std::int64_t, 3> step;

    std::array<std::uint32_t, 3> cell() const {
      return {above(0, FixedPoint::kBits), above(1, FixedPoint::kBits),
              above(2, FixedPoint::kBits)};
    }
    unsigned octant() const { return bits_at(kOctantBits); }
    /// The octant of the octant.
    unsigned part() const { return bits_at(kMinBits); }

   private:
    std::uint32_t above(std::size_t axis, unsigned shift) const {
      return static_cast<std::uint32_t>(step[axis] >> shift);
    }
    unsigned bits_at(unsigned shift) const {
      return (above(0, shift) & 1) | (above(1, shift) & 1) << 1 | (above(2, shift) & 1) << 2;
    }
  };

  /// Steps from 0 to the start of the rim, less half of `uncertainty`; 0 if all is uncertain.
  alignas(32) Axes<std::int64_t> first{};
  /// kRimMiddle of the last cell: the maximum of Position::step.
  alignas(32) Axes<std::int64_t> last_middle{kRimMiddle, kRimMiddle, kRimMiddle, kRimMiddle};
  alignas(32) Axes<std::uint64_t> stride{};  ///< from a brick's number to its neighbour's
  FixedPoint input;                          ///< of coordinates in the input's units
  FixedPoint model;                          ///< of coordinates in the model frame
  /// Width in steps of the uncertainty band about a face, half of it on each side. In the default
  /// every point is uncertain.
  std::int64_t uncertainty = 2 * kMin;

  /// Finds the position of a point. Returns false if the point is in the uncertainty band about a
  /// face, or out of range. Writes `position` in either case.
  bool find(const double* point, const FixedPoint& steps, Position& position) const {
    std::int64_t sign = 0;  // below 0 if any axis is uncertain or out of range
#pragma GCC unroll 3
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const FixedPoint::Digits digits = steps.digits_of(point[axis]);
      const std::int64_t beyond = digits.steps() - first[axis];
      const std::int64_t step = std::min(std::max(kRimMiddle, beyond), last_middle[axis]);
      position.step[axis] = step;
      sign |= digits.shift;
      sign |= (step & (kMin - 1)) - uncertainty;
    }
    return sign >= 0;
  }
  /// Returns the cell at these indices, counted from the start of the rim.
  SideGridCells::Cell cell_at(const std::array<std::uint32_t, 3>& at) const {
    constexpr unsigned kBits = SideGridCells::kBrickBits;
    const auto bits = [&](unsigned bit) {
      return (at[0] >> bit & 1) | (at[1] >> bit & 1) << 1 | (at[2] >> bit & 1) << 2;
    };
    return {(at[2] >> kBits) * stride[2] + (at[1] >> kBits) * stride[1] + (at[0] >> kBits),
            bits(1) << 3 | bits(0)};
  }
};

}  // namespace planetree::octree
