#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/octcode.h"
#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// The box within which the whole surface is known, in the model frame.
///
/// A file may hold only the triangles that touch a given box. A side of that box within the model's
/// box is a wall. The other sides are dropped, since no triangle lies beyond the model's box: the
/// region is unbounded there. Every triangle that the file lacks lies strictly beyond a wall. The
/// region of a complete file is all of space.
class Region {
 public:
  /// All of space.
  Region() = default;
  /// lower, upper          the given box, which may be flat
  /// box_lower, box_upper  the model's box; has a point in common with the given box
  Region(const Point& lower, const Point& upper, const Point& box_lower, const Point& box_upper) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (lower[axis] > box_lower[axis]) lower_[axis] = lower[axis];
      if (upper[axis] < box_upper[axis]) upper_[axis] = upper[axis];
    }
    has_walls_ = lower_.maxCoeff() > -kNone || upper_.minCoeff() < kNone;
  }

  /// Lower walls; -infinity on an axis without one. upper() is infinity there.
  const Point& lower() const { return lower_; }
  const Point& upper() const { return upper_; }

  bool has_walls() const { return has_walls_; }
  /// Returns whether a point is in the region or on a wall.
  bool holds(const Point& point) const {
    return (point.array() >= lower_.array()).all() && (point.array() <= upper_.array()).all();
  }
  /// Returns whether the region has a point in common with a closed box.
  bool meets(const Point& lower, const Point& upper) const {
    return (upper.array() >= lower_.array()).all() && (lower.array() <= upper_.array()).all();
  }
  /// Returns the nearest point of the region.
  Point clamped(const Point& point) const { return point.cwiseMax(lower_).cwiseMin(upper_); }

  /// Returns the distance from a point of the region to the nearest wall, rounded; infinity if
  /// there is no wall.
  double gap(const Point& point) const {
    return std::min((point - lower_).minCoeff(), (upper_ - point).minCoeff());
  }
  /// Returns a distance that all missing triangles exceed, also as evaluated (kValueRounding). The
  /// result is negative outside of the region and close to a wall, and infinity without walls.
  ///
  /// span  TreeInfo::span() of the point
  double clearance(const Point& point, double span) const {
    if (!holds(point)) return -1;
    const double gap_to_wall = gap(point);
    return gap_to_wall < kNone ? gap_to_wall - kValueRounding * (gap_to_wall + span) : kNone;
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  Point lower_ = Point::Constant(-kNone);
  Point upper_ = Point::Constant(kNone);
  bool has_walls_ = false;  // derived from the above; cached because every query reads it
};

/// A cell of the octree, as an octcode names it. `at` counts cells of the cell's own level.
struct GridCell {
  unsigned level = 0;  ///< 0 to kLevels
  std::array<std::uint32_t, 3> at{};

  /// Returns child `octant`: bit 0 selects the upper half in x, bit 1 in y, bit 2 in z.
  constexpr GridCell child(unsigned octant) const {
    return {level + 1,
            {2 * at[0] + (octant & 1), 2 * at[1] + (octant >> 1 & 1), 2 * at[2] + (octant >> 2)}};
  }
  /// Returns the cell that contains this one.
  ///
  /// of_level  0 to `level`
  constexpr GridCell ancestor(unsigned of_level) const {
    const unsigned shift = level - of_level;
    return {of_level, {at[0] >> shift, at[1] >> shift, at[2] >> shift}};
  }
  /// Returns the octant of its parent that ancestor(of_level) is.
  ///
  /// of_level  1 to `level`
  constexpr unsigned octant_of(unsigned of_level) const {
    const unsigned shift = level - of_level;
    return (at[0] >> shift & 1) | (at[1] >> shift & 1) << 1 | (at[2] >> shift & 1) << 2;
  }
  /// Returns the Morton code of the first finest cell in it.
  constexpr std::uint64_t first_code() const {
    const unsigned shift = kLevels - level;
    return morton_code(at[0] << shift, at[1] << shift, at[2] << shift);
  }
  constexpr std::uint64_t octcode() const { return octcode_of_prefix(first_code(), 3 * level); }
};

/// Coordinates of the octree's cells. The root is the cube of side 2 at the least corner of the
/// model's box. A cell is closed and reaches from its lower to its upper sides, as rounded here.
/// Neighbours share the same rounded side, so that cells leave no gap. Rounding may make a cell far
/// from the origin flat.
class CellGrid {
 public:
  /// lower  least corner of the model's box, model frame, of magnitude below 2^55
  explicit CellGrid(const Point& lower) : lower_(lower) {}

  /// Returns the least corner of a cell. upper() returns the greatest; it equals the least corner
  /// of the diagonal neighbour.
  Point lower(const GridCell& cell) const { return corner(cell, 0); }
  Point upper(const GridCell& cell) const { return corner(cell, 7); }
  /// Returns corner `which`; its bits are as in GridCell::child().
  Point corner(const GridCell& cell, unsigned which) const {
    Point result;
#pragma GCC unroll 3
    for (unsigned axis = 0; axis < 3; ++axis)
      result[axis] = side(axis, cell.level, cell.at[axis] + (which >> axis & 1));
    return result;
  }
  /// Returns the common corner of a cell's children.
  Point middle(const GridCell& cell) const { return corner(cell.child(7), 0); }

  /// Returns the octant that a point of the cell lies in. On each axis it is the upper half if the
  /// point is not below the side between the halves.
  unsigned octant(const GridCell& cell, const Point& point) const {
    unsigned octant = 0;
#pragma GCC unroll 3
    for (unsigned axis = 0; axis < 3; ++axis)
      octant |=
          static_cast<unsigned>(side(axis, cell.level + 1, 2 * cell.at[axis] + 1) <= point[axis])
          << axis;
    return octant;
  }

  /// Returns the last finest cell whose lower sides are not beyond `point`, a point of the root. A
  /// walk from the root with octant() leads to the same cell.
  GridCell finest(const Point& point) const {
    GridCell cell{.level = kLevels};
    for (unsigned axis = 0; axis < 3; ++axis) cell.at[axis] = finest(axis, point[axis]);
    return cell;
  }

 private:
  std::uint32_t finest(unsigned axis, double at) const {
    constexpr std::uint32_t kLast = (1 << kLevels) - 1;
    constexpr double kCells = 1 << (kLevels - 1);  // cells in a unit of length
    const double scaled = std::clamp((at - lower_[axis]) * kCells, 0.0, double{kLast});
    const auto guess = static_cast<std::uint32_t>(scaled);
    const auto begins = [&](std::uint32_t index) { return side(axis, kLevels, index) <= at; };
    if (begins(guess) && (guess == kLast || !begins(guess + 1))) return guess;
    // The guess is wrong because it was rounded. The rounded sides decide: a binary search.
    std::uint32_t index = 0;
    for (std::uint32_t half = 1 << (kLevels - 1); half > 0; half /= 2)
      if (begins(index + half)) index += half;
    return index;
  }

  // Coordinate of a side. The product is exact and the sum rounds once, so that sides keep their
  // order.
  double side(unsigned axis, unsigned level, std::uint32_t index) const {
    constexpr double kFinestCell = 2.0 / (1 << kLevels);
    // At most 2^kLevels, so that it fits.
    const auto finest = static_cast<std::int32_t>(index << (kLevels - level));
    return lower_[axis] + kFinestCell * static_cast<double>(finest);
  }

  Point lower_;
};

/// Cells of the octree clipped to a region. Clipped cells are boxes too, and neighbours still share
/// sides. A cell beyond a wall is flat and lies within the wall.
class ClippedGrid {
 public:
  explicit ClippedGrid(const Point& lower, const Region& region = {})
      : grid_(lower), region_(region) {}

  Point lower(const GridCell& cell) const { return corner(cell, 0); }
  Point upper(const GridCell& cell) const { return corner(cell, 7); }
  Point corner(const GridCell& cell, unsigned which) const {
    return region_.clamped(grid_.corner(cell, which));
  }
  Point middle(const GridCell& cell) const { return region_.clamped(grid_.middle(cell)); }
  /// Returns the octant that a point of the region lies in; see CellGrid::octant().
  unsigned octant(const GridCell& cell, const Point& point) const {
    const Point middle = this->middle(cell);
    unsigned octant = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
      octant |= static_cast<unsigned>(middle[axis] <= point[axis]) << axis;
    return octant;
  }

  /// Returns whether the cell contains a point of the region. Callers use only such cells.
  bool has_part_of(const GridCell& cell) const {
    return region_.meets(grid_.lower(cell), grid_.upper(cell));
  }
  const Region& region() const { return region_; }

 private:
  CellGrid grid_;
  Region region_;
};

}  // namespace planetree::octree
