#pragma once

#include <cstdint>
#include <functional>

#include "octree/builder/mask/mask_tree.h"
#include "octree/builder/sort/triangles.h"
#include "octree/geometry/clipped_grid.h"

namespace planetree::octree {

/// Lists the blocks that have triangles in a cell, of a level above kLevels; false where they are
/// not to be listed.
using ListBlocks = std::function<bool(const GridCell& cell, MaskBlocks& blocks)>;

/// The mask of one cell by itself: its entry is the first. Divides the cell until few triangles
/// touch one, and finds the winding number at every corner of those that are left, exactly: from
/// the cell's least corner on, by the crossings of cells' edges. At one corner of every such cell
/// it is counted another way as well. Cells that nobody asks for are white.
///
/// winding    at the cell's least corner.
/// triangles  all that may touch the cell, at least one; only the order of planes in a special
///            cell depends on theirs.
/// memory     about 150 bytes a triangle while it works.
MaskTree mask_of_sector(const ClippedGrid& grid, const GridCell& cell, std::int64_t winding,
                        const Triangles& triangles, const ListBlocks& list);

}  // namespace planetree::octree
