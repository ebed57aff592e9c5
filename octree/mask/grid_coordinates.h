#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "octree/mask/fixed_point.h"
#include "octree/mask/side_grid_cells.h"

namespace planetree::octree {

/// Where points are among the cells of a SideGrid, which has a rim of cells about the model's
/// box: what is farther out is taken for the rim.
struct GridCoordinates {
  static constexpr std::uint32_t kRim = 1;  ///< cells before, and behind, those of the box
  /// Of a cell's octants, and of the octants of those: the least that is told.
  static constexpr unsigned kOctantBits = FixedPoint::kBits - 1, kMinBits = kOctantBits - 1;
  static constexpr std::int64_t kMin = std::int64_t{1} << kMinBits;
  /// In the rim, and off the sides of what is told.
  static constexpr std::int64_t kRimMiddle = FixedPoint::kCell / 2 + kMin / 2;

  /// A value for each axis, and one more that makes a vector whole.
  template <class T>
  using Axes = std::array<T, 4>;

  /// Steps along each axis from `first` on; right but for the bits below kMin.
  struct Position {
    std::array<std::int64_t, 3> step;

    std::array<std::uint32_t, 3> cell() const {
      return {above(0, FixedPoint::kBits), above(1, FixedPoint::kBits),
              above(2, FixedPoint::kBits)};
    }
    unsigned octant() const { return bits_at(kOctantBits); }
    /// Octant of the octant.
    unsigned part() const { return bits_at(kMinBits); }

   private:
    std::uint32_t above(std::size_t axis, unsigned shift) const {
      return static_cast<std::uint32_t>(step[axis] >> shift);
    }
    unsigned bits_at(unsigned shift) const {
      return (above(0, shift) & 1) | (above(1, shift) & 1) << 1 | (above(2, shift) & 1) << 2;
    }
  };

  alignas(32) Axes<std::int64_t> first{};  ///< of the rim, less half of `doubtful`; or 0
  alignas(32) Axes<std::int64_t> last_middle{kRimMiddle, kRimMiddle, kRimMiddle, kRimMiddle};
  alignas(32) Axes<std::uint64_t> stride{};  ///< from a block's number to its neighbour's
  FixedPoint input;                          ///< of the input's units
  FixedPoint model;
  /// Steps about a side where a place is left to rounding, half of them before it; so many that
  /// none is without doubt.
  std::int64_t uncertainty = 2 * kMin;

  /// False where the point is so near to a side that rounding may tell another place, or so far
  /// that it has no place.
  bool find(const double* point, const FixedPoint& steps, Position& position) const {
    std::int64_t sign = 0;  // below 0 if there is any
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
  /// The cell that is so many cells from the first along each axis.
  SideGridCells::Cell cell_at(const std::array<std::uint32_t, 3>& at) const {
    constexpr unsigned kBits = SideGridCells::kBlockBits;
    const auto bits = [&](unsigned bit) {
      return (at[0] >> bit & 1) | (at[1] >> bit & 1) << 1 | (at[2] >> bit & 1) << 2;
    };
    return {(at[2] >> kBits) * stride[2] + (at[1] >> kBits) * stride[1] + (at[0] >> kBits),
            bits(1) << 3 | bits(0)};
  }
};

}  // namespace planetree::octree
