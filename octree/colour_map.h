#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/cell_grid.h"
#include "octree/mask_lookup.h"
#include "octree/tree_view.h"

namespace planetree::octree {

/// The colours of a mask's upper cells side by side, two bits each: one look tells the side of
/// most points of a model's box, and needs no page. Filled once; then any thread may look.
class ColourMap {
 public:
  /// Memory of the map of a model of so many triangles.
  static constexpr std::size_t bytes(std::uint64_t triangles) { return most_cells(triangles) / 4; }

  /// A map that knows nothing.
  ColourMap() = default;

  /// Of a mask's first pages, as far as they can be had.
  /// memory  of bytes(triangles), if there is a mask; must outlive this.
  void fill(const MaskFacts& mask, const TreeFacts& tree, std::uint64_t triangles, PageReader pages,
            std::span<std::uint8_t> memory) noexcept;

  /// The sign of a point's winding number, where its cell is white or black; else kUnknown.
  /// The point is in the model's box.
  int winding(const Point& point) const noexcept {
    std::size_t cell = 0;
    for (unsigned axis = 3; axis-- > 0;) {
      const double place = (point[axis] - lower_[axis]) * cells_per_unit_;
      if (!(place >= 0 && place < count_[axis])) return kUnknown;
      const auto index = static_cast<std::uint32_t>(place);
      // As rounded, sides may be elsewhere than the product says.
      if (!(side(axis, index) <= point[axis] && point[axis] < side(axis, index + 1)))
        return kUnknown;
      cell = cell * count_[axis] + index;
    }
    return static_cast<int>(colours_[cell / 4] >> 2 * (cell % 4) & 3) - 1;
  }

  static constexpr int kUnknown = 2;

 private:
  class Painter;

  static constexpr std::uint64_t most_cells(std::uint64_t triangles) {
    constexpr std::uint64_t kFewestCells = 64, kMostCells = std::uint64_t{1} << 18;
    return std::clamp(triangles / 4 * 4, kFewestCells, kMostCells);
  }
  // As CellGrid's.
  double side(unsigned axis, std::uint32_t index) const {
    return lower_[axis] + cell_side_ * static_cast<double>(index);
  }

  Point lower_ = Point::Zero();
  double cell_side_ = 0;
  double cells_per_unit_ = 0;
  std::array<std::uint32_t, 3> count_{};
  std::uint8_t* colours_ = nullptr;  // kUnknown, less 1, is 3 in two bits
};

}  // namespace planetree::octree
