#pragma once

#include "octree/mask/mask_lookup.h"
#include "octree/page/frame.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// Finds the blocks that are in a height field (octree/nearest/height_field.h).
///
/// The proof is for a prism, a box around the block. Nothing touches its two ends, and the first
/// end is outside of the solid. All triangles in it rise towards the first end, so that crossings
/// only add up. A line through the middle crosses one of them. No cap meets the prism.
class HeightFieldFinder {
 public:
  /// tree, mask  of a whole model; both must outlive this.
  HeightFieldFinder(const TreeInfo& tree, const MaskInfo& mask) : tree_(tree), mask_(mask) {}

  /// Whether the block's own triangles do not rule it out. Most proofs that fail do so by these.
  static bool may_be_height_field(const BlockView& block);

  /// block   need not be in a frame of `pages`.
  /// pages   those of the trees and of the mask.
  /// work    what was visited is added.
  /// return  false where it cannot be proven, and where pages are missing.
  bool is_height_field(const BlockView& block, const PageReader& pages, TraversalStats& work) const;

 private:
  const TreeInfo& tree_;
  const MaskInfo& mask_;
};

}  // namespace planetree::octree
