#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/geometry/cell_grid.h"
#include "octree/mask/cap_grid.h"
#include "octree/mask/grid_coordinates.h"
#include "octree/mask/mask_lookup.h"
#include "octree/mask/side_grid_cells.h"
#include "octree/page/mask_frame.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// Finds what the cells know about a position.
inline SideGridCells::Found find(const GridCoordinates& coordinates, const SideGridCells& cells,
                                 const GridCoordinates::Position& position) {
  const SideGridCells::Cell cell = coordinates.cell_at(position.cell());
  const unsigned code = cells.code_of<1>(cell);
  return code == SideGridCells::kListed ? cells.find_below(cell, position.octant(), position.part())
                                        : cells.find_by_code(code);
}

/// Returns the sign of the winding number at a point, or SideGridCells::kUnknown if integers alone
/// cannot tell it. It computes with integers only, so that the thread's rounding mode and trapped
/// exceptions do not matter.
///
/// x, y, z  in the input's units; any values, also infinite ones and NaN
/// threads  any; no allocation, no lock, no exception.
using SideGridLookup = int (*)(const GridCoordinates& coordinates, const SideGridCells& cells,
                               double x, double y, double z);

/// Returns the fastest implementation for this processor. All return the same signs.
SideGridLookup fastest_side_grid_lookup() noexcept;

/// A table of a mask's cells of one level, with a rim of cells around the core, which are white
/// if there are no strays and no caps nearby, and else unknown. Of
/// grey cells it also has the colours of two more levels, and the slabs of leaves. One lookup tells
/// the side of most points and reads no page. For other points the grid has records of the mask, so
/// that a lookup in the mask need not start at the root. The grid is filled once. Then any thread
/// may look points up.
class SideGrid {
 public:
  /// Bytes of memory for the grid of a model of so many triangles.
  static constexpr std::size_t bytes(std::uint64_t triangles) {
    constexpr std::uint64_t kFewestBytes = 1024, kMaxBytes = std::uint64_t{3} << 19;
    return std::clamp(triangles + triangles / 2, kFewestBytes, kMaxBytes);
  }

  /// Makes a grid that knows nothing. The grid of a model far from the origin, by some 2^25 times
  /// its size, knows nothing either, because steps cannot resolve its cells.
  SideGrid() = default;

  /// Fills the grid from a mask's first pages, as far as these are available.
  ///
  /// clipped  cells are clamped to the walls of a region, so that octants may not be halves.
  /// caps     cells where it is not clear are unknown.
  /// scale    coordinates in the model frame are those of the input times 2^scale.
  /// memory   storage of the grid, aligned to 16 bytes; must outlive this.
  void fill(const MaskInfo& mask, const TreeInfo& tree, const CapGrid& caps, bool clipped,
            int scale, const PageReader& pages, std::span<std::byte> memory) noexcept;

  static constexpr int kUnknown = SideGridCells::kUnknown;

  /// What the grid knows about a point.
  struct Lookup {
    int winding = kUnknown;                  ///< sign of the winding number, or kUnknown
    GridCell cell;                           ///< the grey cell of `record`
    const SideGridRecord* record = nullptr;  ///< null if the grid has none
  };
  /// Looks up a point of the model frame.
  Lookup look(const Point& point) const noexcept {
    return look(point, [](const SideGridRecord&) {});
  }
  /// The same; calls ahead(record) as soon as a record is found that may be used.
  template <class Ahead>
  Lookup look(const Point& point, const Ahead& ahead) const noexcept {
    GridCoordinates::Position position;
    const bool certain = coordinates_.find(point.data(), coordinates_.model, position) ||
                         find_among_sides(point, position);
    return certain ? look_at(position, point, ahead) : Lookup{};
  }
  /// Returns what look() knows about a point in a grey cell before it reads a record. Returns
  /// nothing for other points and for those in the uncertainty band. The record may be that of an
  /// ancestor of the cell returned.
  Lookup lookup_of(const Point& point) const noexcept {
    GridCoordinates::Position position;
    if (!coordinates_.find(point.data(), coordinates_.model, position)) return {};
    const SideGridCells::Cell cell = coordinates_.cell_at(position.cell());
    if (cells_.code_of<1>(cell) != SideGridCells::kListed) return {};
    const SideGridCells::Found found = cells_.find_below(cell, position.octant());
    return {found.winding, octant_at(position), found.record};
  }
  /// Returns the sign of the winding number as look() finds it, if integers alone can tell it; else
  /// kUnknown. Computes nothing with doubles.
  ///
  /// x, y, z  in the input's units; any values, also infinite ones and NaN
  int find_fast(double x, double y, double z) const noexcept {
    return find_fast_(coordinates_, cells_, x, y, z);
  }

 private:
  class SideGridBuilder;

  // Finds the position of a point in the uncertainty band: compares the point with the faces as
  // CellGrid rounds them, which may differ from the faces of whole steps. Returns false in the rim,
  // and if the point is not in the cell that its steps say.
  bool find_among_sides(const Point& point, GridCoordinates::Position& position) const {
    constexpr std::uint32_t kRim = GridCoordinates::kRim;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const std::int64_t at =
          (position.step[axis] - coordinates_.uncertainty / 2) >> FixedPoint::kBits;
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
    const SideGridCells::Found found = find(coordinates_, cells_, position);
    if (found.winding != kUnknown) return {found.winding, {}, nullptr};
    if (!found.record || found.record->is_nothing()) return {};
    ahead(*found.record);
    const GridCell octant = octant_at(position);
    const unsigned above = found.record->levels_above();
    return find_by_slab({kUnknown, octant.ancestor(octant.level - above), found.record}, point);
  }
  GridCell octant_at(const GridCoordinates::Position& position) const {
    constexpr std::uint32_t kRim = GridCoordinates::kRim;
    const auto at = position.cell();
    const GridCell cell{level_, {at[0] - kRim, at[1] - kRim, at[2] - kRim}};
    return cell.child(position.octant());
  }
  // Finds the winding number by the slab of a leaf, if it has one that the point is beyond.
  Lookup find_by_slab(const Lookup& lookup, const Point& point) const {
    if (!lookup.record->is_listed()) return lookup;
    const Point lower = CellGrid(lower_).lower(lookup.cell);
    const unsigned corner =
        CellSlab::of_word(lookup.record->slab)
            .corner_beyond(CellSlab::position_in(point, lower, lookup.cell.level));
    if (corner == CellSlab::kNoCorner) return lookup;
    return {corner_number(lookup.record->listed(0), corner), {}, nullptr};
  }
  // Coordinate of a face, as CellGrid rounds it. `at` counts octants of octants.
  double side(unsigned axis, std::int64_t at) const {
    return lower_[axis] + min_side_ * static_cast<double>(at);
  }
  std::uint32_t bricks_along(unsigned axis) const {
    return ((width_[axis] - 1) >> SideGridCells::kBrickBits) + 1;
  }
  void measure(const Point& size, unsigned level, bool clipped, int scale);
  bool fill_cells(const MaskInfo& mask, const CapGrid& caps, const PageReader& pages, bool clipped,
                  std::span<std::byte> memory);

  GridCoordinates coordinates_;
  SideGridCells cells_;
  SideGridLookup find_fast_ = fastest_side_grid_lookup();
  std::array<std::uint32_t, 3> width_{};  // in cells, with the rim
  unsigned level_ = 0;
  Point lower_ = Point::Zero();
  double min_side_ = 0;
};

/// Finds the cell of the mask that a point is in, as look_up() of mask_lookup.h does. It starts at
/// the record in `lookup`, which a side grid returned for the point; without one, at the root.
MaskLookup look_up(const MaskInfo& mask, const SideGrid::Lookup& lookup, const Point& point,
                   std::uint64_t max_work, const PageReader& pages, TraversalStats& work) noexcept;

}  // namespace planetree::octree
