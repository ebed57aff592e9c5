#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "octree/builder/tree/wide_tree.h"

namespace planetree::octree {

/// Frame slots that records take.
struct RecordSlots {
  unsigned node = kNodeSlots;
  std::span<const std::uint8_t> blocks;  ///< of each block
};

/// A record of a WideTree.
struct RecordRef {
  bool block = false;
  std::uint32_t index = 0;
};

/// A subtree that stays together, without the subtrees cut off below it.
struct Treelet {
  RecordRef root;
  std::uint32_t slots = 0;
};

/// A tree cut into treelets. `cut_nodes[i]` says that node i is the root of
/// one, `cut_blocks[i]` that block i is one by itself.
struct TreeletCut {
  std::vector<Treelet> treelets;
  std::vector<bool> cut_nodes;
  std::vector<bool> cut_blocks;
};

/// Cuts a tree bottom-up: first every largest subtree of at most
/// `bottom_slots`, then, in what is left, every largest one of at most
/// `upper_slots`, and again until the root's is cut. Blocks stay with a node of
/// an upper treelet while they and it fit `bottom_slots`.
TreeletCut cut_treelets(const WideTree& tree, const RecordSlots& slots, std::uint32_t bottom_slots,
                        std::uint32_t upper_slots);

}  // namespace planetree::octree
