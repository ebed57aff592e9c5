#pragma once

#include "octree/mask/mask_lookup.h"
#include "octree/page/block_view.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// Tells which blocks are in a sheet (octree/nearest/height_field.h).
///
/// It is proven for a box around the block: nothing touches its two ends, of which the first is
/// outside; all triangles in it rise towards the first, so that crossings only add up; and a line
/// through the middle crosses one of them.
class HeightFieldFinder {
 public:
  /// Of a whole watertight model. Both must outlive this.
  HeightFieldFinder(const TreeInfo& tree, const MaskInfo& mask) : tree_(tree), mask_(mask) {}

  /// Whether the block's own triangles do not rule it out: most of the proof's failures are theirs.
  static bool may_be_height_field(const BlockView& block);

  /// block   need not be in a frame of `pages`.
  /// pages   those of the tree and of the mask.
  /// return  false where it cannot be proven, and where pages are missing.
  bool is_height_field(const BlockView& block, const PageReader& pages) const;

 private:
  const TreeInfo& tree_;
  const MaskInfo& mask_;
};

}  // namespace planetree::octree
