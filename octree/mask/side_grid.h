#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/geometry/cell_grid.h"
#include "octree/mask/fixed_point.h"
#include "octree/mask/grid_coordinates.h"
#include "octree/mask/mask_lookup.h"
#include "octree/mask/side_grid_cells.h"
#include "octree/mask/side_grid_lookup.h"
#include "octree/mask/side_grid_record.h"
#include "octree/page/mask_frame.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// A mask's cells of one level side by side, with a rim of white ones about the model's box, and
/// in the grey ones those of two levels more, and the slabs of leaves: one look tells the side of
/// most points, and needs no page. For the rest there are records of the mask, so that a lookup
/// need not begin at the root. Filled once; then any thread may look.
class SideGrid {
 public:
  /// Memory of the map of a model of so many triangles.
  static constexpr std::size_t bytes(std::uint64_t triangles) {
    constexpr std::uint64_t kFewestBytes = 1024, kMaxBytes = std::uint64_t{3} << 19;
    return std::clamp(triangles + triangles / 2, kFewestBytes, kMaxBytes);
  }

  /// A map that knows nothing; as do those of models so far from the origin that steps have no
  /// room: some 2^25 times their size.
  SideGrid() = default;

  /// Of a mask's first pages, as far as they can be had.
  ///
  /// clipped  by the walls of a region, so that cells' octants may be others than halves.
  /// scale    model frame's units are 2^scale of the input's.
  /// memory   where the map is to be, on a boundary of 16 bytes; must outlive this.
  void fill(const MaskInfo& mask, const TreeInfo& tree, bool clipped, int scale,
            const PageReader& pages, std::span<std::byte> memory) noexcept;

  static constexpr int kUnknown = SideGridCells::kUnknown;

  /// What the map knows of a point.
  struct Lookup {
    int winding = kUnknown;                  ///< its sign, where that is known; else kUnknown
    GridCell cell;                           ///< grey: the one that
    const SideGridRecord* record = nullptr;  ///< this is of; null where the map has none
  };
  Lookup look(const Point& point) const noexcept {
    return look(point, [](const SideGridRecord&) {});
  }
  /// Calls ahead(record) as soon as there is a record that may be wanted.
  template <class Ahead>
  Lookup look(const Point& point, const Ahead& ahead) const noexcept {
    GridCoordinates::Position position;
    const bool certain =
        steps_.find(point.data(), steps_.model, position) || find_among_sides(point, position);
    return certain ? look_at(position, point, ahead) : Lookup{};
  }
  /// What a look sees before it reads a record, where steps tell the point's place; else nothing.
  /// Where there is a record, it is of the cell or of one above.
  Lookup lookup_of(const Point& point) const noexcept {
    GridCoordinates::Position position;
    if (!steps_.find(point.data(), steps_.model, position)) return {};
    const SideGridCells::Cell cell = steps_.cell_at(position.cell());
    if (cells_.code_of<1>(cell) != SideGridCells::kListed) return {};
    const SideGridCells::Found found = cells_.find_below(cell, position.octant());
    return {found.winding, octant_at(position), found.record};
  }
  /// The winding number's sign that a look finds, of a point in the input's units, where whole
  /// numbers tell it; else kUnknown. Nothing is computed with doubles. The point may be any, and no
  /// number.
  int find_fast(double x, double y, double z) const noexcept {
    return find_fast_(steps_, cells_, x, y, z);
  }

 private:
  class SideGridBuilder;

  // As rounded, sides may be elsewhere than steps say.
  bool find_among_sides(const Point& point, GridCoordinates::Position& position) const {
    constexpr std::uint32_t kRim = GridCoordinates::kRim;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const std::int64_t at = (position.step[axis] - steps_.uncertainty / 2) >> FixedPoint::kBits;
      if (at < kRim || at + kRim >= width_[axis]) return false;
      const std::int64_t first = 4 * (at - kRim);
      if (!(side(axis, first) <= point[axis] && point[axis] < side(axis, first + 4))) return false;
      std::int64_t parts = side(axis, first + 2) <= point[axis] ? 2 : 0;
      if (side(axis, first + parts + 1) <= point[axis]) ++parts;
      position.step[axis] = at * FixedPoint::kCell + parts * GridCoordinates::kMin;
    }
    return true;
  }
  template <class Ahead>
  Lookup look_at(const GridCoordinates::Position& position, const Point& point,
                 const Ahead& ahead) const {
    const SideGridCells::Found found = find(steps_, cells_, position);
    if (found.winding != kUnknown) return {found.winding, {}, nullptr};
    if (!found.record || found.record->is_nothing()) return {};
    ahead(*found.record);
    const GridCell octant = octant_at(position);
    const unsigned above = found.record->levels_above();
    return query_slab({kUnknown, octant.ancestor(octant.level - above), found.record}, point);
  }
  GridCell octant_at(const GridCoordinates::Position& position) const {
    constexpr std::uint32_t kRim = GridCoordinates::kRim;
    const auto at = position.cell();
    const GridCell cell{level_, {at[0] - kRim, at[1] - kRim, at[2] - kRim}};
    return cell.child(position.octant());
  }
  // Of a leaf that has one.
  Lookup query_slab(const Lookup& lookup, const Point& point) const {
    if (!lookup.record->is_listed()) return lookup;
    const Point lower = CellGrid(lower_).lower(lookup.cell);
    const unsigned corner =
        CellSlab::of_word(lookup.record->slab)
            .corner_beyond(CellSlab::position_in(point, lower, lookup.cell.level));
    if (corner == CellSlab::kNoCorner) return lookup;
    return {corner_of(lookup.record->listed(0), corner), {}, nullptr};
  }
  // As CellGrid's; in the least of what is told.
  double side(unsigned axis, std::int64_t at) const {
    return lower_[axis] + min_side_ * static_cast<double>(at);
  }
  std::uint32_t blocks_along(unsigned axis) const {
    return ((width_[axis] - 1) >> SideGridCells::kBlockBits) + 1;
  }
  void measure(const Point& size, unsigned level, bool clipped, int scale);
  bool fill_cells(const MaskInfo& mask, const PageReader& pages, bool clipped,
                  std::span<std::byte> memory);

  GridCoordinates steps_;
  SideGridCells cells_;
  SideGridLookup find_fast_ = map_glance();
  std::array<std::uint32_t, 3> width_{};  // with the rim
  unsigned level_ = 0;
  Point lower_ = Point::Zero();
  double min_side_ = 0;
};

/// Finds the cell of the mask that a point is in, from where a map of the mask's colours has found
/// `spot` for it.
MaskLookup look_up(const MaskInfo& mask, const SideGrid::Lookup& lookup, const Point& point,
                   std::uint64_t max_work, const PageReader& pages, TraversalStats& work) noexcept;

}  // namespace planetree::octree
