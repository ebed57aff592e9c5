#pragma once

#include <cstdint>
#include <vector>

#include "octree/build/mesh_store.h"
#include "octree/build/morton_order.h"
#include "octree/build/special_cell.h"
#include "octree/mask_frame.h"

namespace planetree::octree {

/// A grey cell of the mask.
struct MaskEntry {
  enum class Kind : std::uint8_t { kNode, kCorners, kSpecial };

  Kind kind = Kind::kNode;
  /// Of a node: its octants, as in MaskNode. `first` is the entry of its first
  /// grey octant, the others follow.
  std::uint8_t grey = 0, leaf = 0, black = 0, inverted = 0;
  std::uint32_t first = 0;  ///< of a special cell: into MaskTree::specials
  MaskCorners corners{};
};

/// The mask of a watertight model.
struct MaskTree {
  std::vector<MaskEntry> entries;  ///< 0 is the root; children come after their parent
  std::vector<SpecialCell> specials;
  unsigned levels = 0;  ///< level of the finest grey cell
};

/// Divides the octree's root until few triangles touch a cell, and finds the
/// winding number at every corner of those that are left, exactly: from a corner
/// outside the box on, by the crossings of cells' edges. At one corner of every
/// such cell it is counted another way as well.
///
/// mesh    watertight, in the model frame.
/// keys    triangles in the order to look at them; only the order of planes in a
///         special cell depends on it.
/// memory  about 25 bytes a triangle while it works, and 20 bytes an entry: one
///         for 4 to 8 triangles.
/// Uses the calling thread's TBB arena; the result depends on the input alone.
///
/// source  white, black and grey cells: "Out-of-core real-time haptic interaction
///         on very large models", section 3.1; winding numbers at corners, in
///         place of parity along a line, are ours.
MaskTree build_mask(const MeshStore& mesh, const std::vector<MortonKey>& keys);

}  // namespace planetree::octree
