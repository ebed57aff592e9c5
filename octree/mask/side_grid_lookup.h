#pragma once

#include <cstddef>

#include "octree/mask/grid_coordinates.h"
#include "octree/mask/side_grid_cells.h"

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

}  // namespace planetree::octree
