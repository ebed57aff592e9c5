#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "octree/builder/mask/special_cell.h"
#include "octree/page/mask_frame.h"

namespace planetree::octree {

/// A grey cell of the mask.
struct MaskEntry {
  /// kSector is a node whose octants are in a mask of their own.
  enum class Kind : std::uint8_t { kNode, kSector, kCorners, kSpecial, kListed };

  Kind kind = Kind::kNode;
  /// For a node: its octants, as in MaskNode. `first` is the entry of its first grey octant, and
  /// the others follow. For a sector: `first` is its number.
  std::uint8_t grey = 0, leaf = 0, black = 0, inverted = 0;
  /// For a special cell: index in MaskTree::specials; for a listed one: index in MaskTree::lists.
  std::uint32_t first = 0;
  bool is_leaf() const { return kind != Kind::kNode && kind != Kind::kSector; }
  MaskCorners corners{};  ///< also for a listed cell
};

/// The mask of a watertight model.
struct MaskTree {
  std::vector<MaskEntry> entries;  ///< 0 is the root; children come after their parent
  std::vector<SpecialCell> specials;
  std::vector<MaskBlocks> lists;
  unsigned levels = 0;  ///< level of the finest grey cell

  /// Makes entry `index` that of a divided cell, and adds entries for its grey octants.
  /// winding  numbers at the octants' least corners, which colour the octants that are not grey.
  void divide(std::size_t index, const std::array<bool, 8>& grey,
              const std::array<std::int64_t, 8>& winding);
  /// Records in entry `node` whether its octant with entry `child` is a leaf.
  void note_leaf(std::size_t node, unsigned octant, std::size_t child);
};

}  // namespace planetree::octree
