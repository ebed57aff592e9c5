#pragma once

#include <cstddef>

#include "octree/mask/grid_coordinates.h"
#include "octree/mask/side_grid_cells.h"

namespace planetree::octree {

/// What is known of a place.
inline MapCells::Found find(const MapSteps& steps, const MapCells& cells,
                            const MapSteps::Place& place) {
  const MapCells::Cell cell = steps.cell_at(place.cell());
  const unsigned code = cells.code_of<1>(cell);
  return code == MapCells::kListed ? cells.find_below(cell, place.octant(), place.part())
                                   : cells.find_by_code(code);
}

/// Tells the sign of the winding number at a point, in the input's units; MapCells::kUnknown where
/// that takes more than whole numbers. Computes with nothing else: it does not matter how the
/// thread rounds, or what it has trapped.
///
/// threads  any; no allocation, no lock, no exception.
using MapGlance = int (*)(const MapSteps& steps, const MapCells& cells, double x, double y,
                          double z);

/// The fastest there is here: all tell the same.
MapGlance map_glance() noexcept;

}  // namespace planetree::octree
