#pragma once

#include <cstdint>
#include <functional>

#include "octree/builder/mask/mask_tree.h"
#include "octree/builder/sort/triangles.h"
#include "octree/geometry/cell_grid.h"

namespace planetree::octree {

/// Lists the blocks that have triangles in a cell with a level less than kLevels; false if the cell
/// is not to list them.
using ListBlocks = std::function<bool(const GridCell& cell, MaskBlocks& blocks)>;

/// Builds the mask of one cell by itself, with the cell's entry as the first. Divides the cell
/// until few triangles touch a cell. Finds the winding number at every corner of the remaining
/// cells exactly: from the least corner on, by the crossings of cells' edges. At one corner of
/// every such cell the number is counted along other edges as well. Cells outside of the region are
/// white.
///
/// winding    number at the cell's least corner.
/// spread     MaskSectors::spread(): the more, the less cells of needles are divided.
/// triangles  all that may touch the cell, at least one. Only the order of planes in a special cell
///            depends on their order.
/// memory     about 150 bytes a triangle during the call.
MaskTree mask_of_sector(const ClippedGrid& grid, const GridCell& cell, std::int64_t winding,
                        std::uint64_t spread, const Triangles& triangles, const ListBlocks& list);

}  // namespace planetree::octree
