#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "octree/geometry/octcode.h"
#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// A cube of the octree that octcodes name, `at` in cells of its level.
struct GridCell {
  unsigned level = 0;  ///< 0 to kLevels
  std::array<std::uint32_t, 3> at{};

  /// Child `octant`: bit 0 is the upper half in x, bit 1 in y, bit 2 in z.
  constexpr GridCell child(unsigned octant) const {
    return {level + 1,
            {2 * at[0] + (octant & 1), 2 * at[1] + (octant >> 1 & 1), 2 * at[2] + (octant >> 2)}};
  }
  /// The cell of a level above, or this one, that this one is in.
  constexpr GridCell ancestor(unsigned of_level) const {
    const unsigned shift = level - of_level;
    return {of_level, {at[0] >> shift, at[1] >> shift, at[2] >> shift}};
  }
  /// Which child of its parent the cell of a level above, or this one, is; of a level from 1 on.
  constexpr unsigned octant_of(unsigned of_level) const {
    const unsigned shift = level - of_level;
    return (at[0] >> shift & 1) | (at[1] >> shift & 1) << 1 | (at[2] >> shift & 1) << 2;
  }
  /// The Morton code of the first of the finest cells in it.
  constexpr std::uint64_t first_code() const {
    const unsigned shift = kLevels - level;
    return morton_code(at[0] << shift, at[1] << shift, at[2] << shift);
  }
  constexpr std::uint64_t octcode() const { return octcode_of_prefix(first_code(), 3 * level); }
};

/// Where the octree's cells are. Its root is the cube of side 2 at the least
/// corner of the model's box; a cell is closed, from its lower to its upper
/// sides as rounded here. Neighbours have the same side between them, so that
/// cells leave no gap; rounding may make a cell far from the origin flat.
class CellGrid {
 public:
  /// lower  least corner of the model's box, model frame, of magnitude below 2^55.
  explicit CellGrid(const Point& lower) : lower_(lower) {}

  /// The least corner of a cell; the greatest is that of the cell diagonal to it.
  Point lower(const GridCell& cell) const { return corner(cell, 0); }
  Point upper(const GridCell& cell) const { return corner(cell, 7); }
  /// Corner `which`: bits as those of GridCell::child().
  Point corner(const GridCell& cell, unsigned which) const {
    Point result;
#pragma GCC unroll 3
    for (unsigned axis = 0; axis < 3; ++axis)
      result[axis] = side(axis, cell.level, cell.at[axis] + (which >> axis & 1));
    return result;
  }
  /// The sides between a cell's children.
  Point middle(const GridCell& cell) const { return corner(cell.child(7), 0); }

  /// The octant of a cell that a point of it is in: an upper half wherever the point is not
  /// below the side between the halves.
  unsigned octant(const GridCell& cell, const Point& point) const {
    unsigned octant = 0;
#pragma GCC unroll 3
    for (unsigned axis = 0; axis < 3; ++axis)
      octant |=
          static_cast<unsigned>(side(axis, cell.level + 1, 2 * cell.at[axis] + 1) <= point[axis])
          << axis;
    return octant;
  }

  /// The last of the finest cells that do not begin beyond a point of the root: that which
  /// is reached by taking, from the root down, the upper half wherever the point is not
  /// below the side between the halves.
  GridCell finest(const Point& point) const {
    GridCell cell{.level = kLevels};
    for (unsigned axis = 0; axis < 3; ++axis) cell.at[axis] = finest(axis, point[axis]);
    return cell;
  }

 private:
  std::uint32_t finest(unsigned axis, double at) const {
    constexpr std::uint32_t kLast = (1 << kLevels) - 1;
    constexpr double kCells = 1 << (kLevels - 1);  // in a unit
    const double scaled = std::clamp((at - lower_[axis]) * kCells, 0.0, double{kLast});
    const auto guess = static_cast<std::uint32_t>(scaled);
    const auto begins = [&](std::uint32_t index) { return side(axis, kLevels, index) <= at; };
    if (begins(guess) && (guess == kLast || !begins(guess + 1))) return guess;
    // Rounding made the guess another cell than that which the sides, rounded too, tell.
    std::uint32_t index = 0;
    for (std::uint32_t half = 1 << (kLevels - 1); half > 0; half /= 2)
      if (begins(index + half)) index += half;
    return index;
  }

  // The product is exact; one rounding, so sides never change places.
  double side(unsigned axis, unsigned level, std::uint32_t index) const {
    constexpr double kFinestCell = 2.0 / (1 << kLevels);
    // At most 2^kLevels.
    const auto finest = static_cast<std::int32_t>(index << (kLevels - level));
    return lower_[axis] + kFinestCell * static_cast<double>(finest);
  }

  Point lower_;
};

}  // namespace planetree::octree
