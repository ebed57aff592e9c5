#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "octree/builder/tree/wide_tree.h"

namespace planetree::octree {

/// Number of frame slots of each record.
struct RecordSlots {
  unsigned node = kNodeSlots;
  std::span<const std::uint8_t> blocks;  ///< slots of each block
};

/// A record of a WideTree.
struct RecordRef {
  bool block = false;
  std::uint32_t index = 0;
};

/// A subtree that stays together, without the subtrees that are cut off below it.
struct Treelet {
  RecordRef root;
  std::uint32_t slots = 0;
};

/// A tree cut into treelets. cut_nodes[i] says that node i is the root of a treelet, cut_blocks[i]
/// that block i is a treelet by itself.
struct TreeletCut {
  std::vector<Treelet> treelets;
  std::vector<bool> cut_nodes;
  std::vector<bool> cut_blocks;
};

/// Cuts a tree from the bottom up: first every largest subtree of at most `bottom_slots`; then, in
/// what is left, every largest subtree of at most `upper_slots`, again and again until the root is
/// cut. A node's blocks stay with the node if it and they fit in `bottom_slots`. Otherwise each of
/// them is a treelet by itself.
TreeletCut cut_treelets(const WideTree& tree, const RecordSlots& slots, std::uint32_t bottom_slots,
                        std::uint32_t upper_slots);

}  // namespace planetree::octree
