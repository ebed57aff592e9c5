#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/surface/edge_crossings.h"
#include "octree/geometry/cell_grid.h"
#include "octree/geometry/cell_slab.h"

namespace planetree::octree {

/// Fits a slab to the surface in a cell: across the mean of the triangles' normals, and around all
/// their vertices.
///
/// lower      least corner of the cell, which is not clamped.
/// triangles  those at `positions` are all that may touch the cell.
CellSlab fit_slab(const GridCell& cell, const Point& lower,
                  const std::vector<BoxedTriangle>& triangles,
                  const std::vector<std::uint32_t>& positions);

}  // namespace planetree::octree
