#pragma once

#include "octree/geometry/cell_slab.h"
#include "octree/geometry/triangle_distance.h"

namespace planetree::tools {

/// Whether the part of a triangle within a cell is within the cell's slab, up to rounding.
///
/// triangle, lower, upper  the triangle and the cell's corners, model frame
/// level                   the cell's level
bool is_within_slab(const octree::CellSlab& slab, const octree::Triangle& triangle,
                    const octree::Point& lower, const octree::Point& upper, unsigned level);

}  // namespace planetree::tools
