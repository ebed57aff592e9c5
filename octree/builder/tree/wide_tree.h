#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "octree/builder/tree/binary_tree.h"
#include "octree/geometry/child_bounds.h"
#include "octree/page/frame.h"
#include "octree/page/moments.h"

namespace planetree::octree {

/// One child of a wide node: a wide node, or a block of triangles.
struct WideChild {
  bool block = false;
  std::uint32_t index = 0;  ///< into WideTree::nodes or WideTree::blocks
  std::uint32_t begin = 0;  ///< its triangles are keys[begin ... end)
  std::uint32_t end = 0;
  FloatBox true_box;   ///< encloses the triangles
  PackedChild packed;  ///< as stored
  FloatBox box;        ///< as decoded; encloses true_box

  std::uint32_t count() const { return end - begin; }
};

struct WideNode {
  FloatBox box;  ///< as decoded from its parent; the root's is exact
  std::uint8_t child_count = 0;
  std::uint8_t height = 0;
  std::array<WideChild, kFanOut> children;
};

/// The triangles keys[begin ... end), at most 16.
struct WideBlock {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

/// The tree as it is stored: nodes of up to eight children, with boxes that are rounded to what is
/// stored. Parents come before children. A model of at most 16 triangles is one block without a
/// node.
struct WideTree {
  std::vector<WideNode> nodes;
  std::vector<WideBlock> blocks;
  std::vector<NodeMoments> moments;  ///< by node; empty if the model is watertight
};

/// Collapses a binary tree into wide nodes so that the sum of their surface areas is least. A node
/// then has about six of eight children. The leaves become blocks as they are.
///
/// keeps_root  the root keeps its two children, which begin pages of their own. Where one of them
/// is
///             far larger than the other, the steps of the root's box resolve nothing of the other.
WideTree collapse(const std::vector<BinaryNode>& binary, bool keeps_root = false);

/// Puts a node between a node and one of its blocks. The block becomes the only child of the new
/// node, which is the last of the tree. Heights are not raised, see raise_heights().
void part_block(WideTree& tree, std::uint32_t node, unsigned child);

/// Gives a tree that is one block, of this box, a node as its root.
void add_root(WideTree& tree, const FloatBox& box);

/// Sets the heights of all nodes.
void raise_heights(WideTree& tree);

}  // namespace planetree::octree
