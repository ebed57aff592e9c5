#pragma once

#include <cstdint>

#include "octree/geometry/cell_grid.h"
#include "octree/page/mask_frame.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// Finds the blocks of a surface and of its caps that have triangles in a cell of the mask, and the
/// octants of the cell that they touch, so that a query in the cell need not traverse the tree to
/// them.
class BlockLister {
 public:
  /// Both arguments must outlive this.
  BlockLister(const TreeInfo& tree, const ClippedGrid& grid) : tree_(tree), grid_(grid) {}

  enum class Outcome {
    kListed,
    kTooMany,  ///< more than kMaxListed, or too many boxes meet the cell
    kLost,     ///< a page could not be read
  };
  /// Lists the blocks in the order of their links, which are numbered.
  ///
  /// cell    its level is less than kLevels.
  /// blocks  undefined unless kListed.
  Outcome list(const GridCell& cell, const PageReader& pages, MaskBlocks& blocks) const;

 private:
  const TreeInfo& tree_;
  const ClippedGrid& grid_;
};

}  // namespace planetree::octree
