#pragma once

#include "octree/geometry/cell_slab.h"
#include "octree/geometry/triangle_distance.h"

namespace planetree::tools {

/// Whether what a triangle has in a cell, up to rounding, is within the cell's slab.
///
/// lower, upper  corners of the cell
/// level         its
bool keeps_to_slab(const octree::CellSlab& slab, const octree::Triangle& triangle,
                   const octree::Point& lower, const octree::Point& upper, unsigned level);

}  // namespace planetree::tools
