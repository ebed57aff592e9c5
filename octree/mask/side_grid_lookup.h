#pragma once

#include <cstddef>

#include "octree/mask/grid_coordinates.h"
#include "octree/mask/side_grid_cells.h"

namespace planetree::octree {

/// What is known of a place.
inline SideGridCells::Found find(const GridCoordinates& steps, const SideGridCells& cells,
                                 const GridCoordinates::Position& position) {
  const SideGridCells::Cell cell = steps.cell_at(position.cell());
  const unsigned code = cells.code_of<1>(cell);
  return code == SideGridCells::kListed ? cells.find_below(cell, position.octant(), position.part())
                                        : cells.find_by_code(code);
}

/// Tells the sign of the winding number at a point, in the input's units; SideGridCells::kUnknown
/// where that takes more than whole numbers. Computes with nothing else: it does not matter how the
/// thread rounds, or what it has trapped.
///
/// threads  any; no allocation, no lock, no exception.
using SideGridLookup = int (*)(const GridCoordinates& steps, const SideGridCells& cells, double x,
                               double y, double z);

/// The fastest there is here: all tell the same.
SideGridLookup map_glance() noexcept;

}  // namespace planetree::octree
