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

/// A subtree that stays together, without the subtrees that are cut off below it.
struct Treelet {
  std::uint32_t root = 0;  ///< a node
  std::uint32_t slots = 0;
};

/// A tree cut into treelets. cut_nodes[i] says that node i is the root of a treelet.
struct TreeletCut {
  std::vector<Treelet> treelets;
  std::vector<bool> cut_nodes;
};

/// Returns the maximum number of slots of a treelet at the bottom: a quarter page, but enough for a
/// node with any one of the blocks.
std::uint32_t bottom_slots(std::uint32_t page_bytes, const RecordSlots& slots);

/// Returns the slots of a node and of its blocks.
std::uint32_t slots_with_blocks(const WideNode& node, const RecordSlots& slots);

/// Cuts a tree from the bottom up: first every largest subtree of at most `bottom_slots`; then, in
/// what is left, every largest subtree of at most `upper_slots`, again and again until the root is
/// cut. A node's blocks stay with the node.
///
/// tree  has a node; each node fits in `bottom_slots` with its blocks, see part_blocks().
TreeletCut cut_treelets(const WideTree& tree, const RecordSlots& slots, std::uint32_t bottom_slots,
                        std::uint32_t upper_slots);

}  // namespace planetree::octree
