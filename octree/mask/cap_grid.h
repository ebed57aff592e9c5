#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/geometry/octcode.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// Tells where caps have no influence on sides. In a clear cell there is no cap, and the caps'
/// share of winding numbers is certainly below one half. So the winding number of the surface with
/// its caps, which is whole and constant off the surface, tells the side there: inside unless it is
/// 0. The cells are those of a cube about the core, an eighth of its longest edge larger on each
/// side.
///
/// Filled once; then any thread may ask it.
class CapGrid {
 public:
  static constexpr unsigned kLevel = 6;  ///< of the cells, below the cube
  static constexpr std::uint32_t kWidth = 1U << kLevel;
  static constexpr std::size_t kBytes = std::size_t{1} << (3 * kLevel - 3);

  /// A grid whose cells are all clear, for a surface without caps.
  CapGrid() = default;
  /// A grid of which no cell is clear.
  static CapGrid unfilled() {
    CapGrid grid;
    grid.has_caps_ = true;
    return grid;
  }

  /// Finds the clear cells.
  ///
  /// caps     the tree of the caps.
  /// surface  the tree of the surface. Its number of records bounds the work: the cells of a small
  ///          model need not be small.
  /// memory   kBytes, aligned to 8 bytes; must outlive this.
  void fill(const TreeInfo& caps, const TreeInfo& surface, const PageReader& pages,
            std::span<std::byte> memory) noexcept;

  /// Returns whether a point is in a clear cell.
  bool is_clear(const Point& point) const {
    if (!clear_) return !has_caps_;
    std::array<std::uint32_t, 3> at;
    return cell_of(point, at) && is_clear_at(at);
  }
  /// Returns whether all points between two points are in clear cells, if these are near each
  /// other. False for points far apart.
  bool is_clear_between(const Point& a, const Point& b) const {
    if (!clear_) return !has_caps_;
    std::array<std::uint32_t, 3> from, to;
    if (!cell_of(a.cwiseMin(b), from) || !cell_of(a.cwiseMax(b), to)) return false;
    for (unsigned axis = 0; axis < 3; ++axis)
      if (to[axis] - from[axis] >= kMaxBetween) return false;
    return all_are_clear(from, to);
  }
  /// Returns whether all points of a box are in clear cells.
  bool is_clear_box(const Point& lower, const Point& upper) const {
    if (!clear_) return !has_caps_;
    std::array<std::uint32_t, 3> from, to;
    return cell_of(lower, from) && cell_of(upper, to) && all_are_clear(from, to);
  }

 private:
  class AreaFiller;
  class RimFiller;
  static constexpr double kSidePerCore = 1.25;
  static constexpr std::uint32_t kMaxBetween = 4;  // cells along an axis

  // Returns false if a point is in no cell.
  bool cell_of(const Point& point, std::array<std::uint32_t, 3>& at) const {
    for (unsigned axis = 0; axis < 3; ++axis) {
      const double steps = (point[axis] - lower_[axis]) * cells_per_unit_;
      if (!(steps >= 0 && steps < kWidth)) return false;
      at[axis] = static_cast<std::uint32_t>(steps);
    }
    return true;
  }
  // Cells within a cell are side by side in Morton order.
  static constexpr std::uint64_t first_of(unsigned level, std::uint64_t index) {
    return index << 3 * (kLevel - level);
  }
  // Whether all cells within a cell of a level are clear.
  bool is_set(unsigned level, std::uint64_t index) const;
  void set_clear(unsigned level, std::uint64_t index);
  // Box of a cell and its slack, model frame.
  void find_box(unsigned level, std::uint64_t index, Point& lower, Point& upper) const;
  static std::uint64_t index_of(const std::array<std::uint32_t, 3>& at) {
    return morton_code(at[0], at[1], at[2]);
  }
  bool is_clear_at(const std::array<std::uint32_t, 3>& at) const {
    const std::uint64_t index = index_of(at);
    return (clear_[index / 64] >> index % 64 & 1) != 0;
  }
  bool all_are_clear(const std::array<std::uint32_t, 3>& from,
                     const std::array<std::uint32_t, 3>& to) const;

  Point lower_ = Point::Zero();  // of the cube
  double side_ = 2;              // of the cube
  double cells_per_unit_ = 0;
  std::uint64_t* clear_ = nullptr;  // a bit for each cell, in Morton order; null: not filled
  bool has_caps_ = false;
};

}  // namespace planetree::octree
