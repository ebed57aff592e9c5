#pragma once

#include <vector>

#include "octree/build/mesh_store.h"
#include "octree/build/morton_order.h"
#include "octree/build/wide_tree.h"
#include "octree/moments.h"

namespace planetree::octree {

/// The moments of every node's children, by node, rounded to what is stored.
///
/// A child's sums are those of its triangles, or of its own children, in their
/// order; so the result depends on the tree alone.
///
/// centre   of the model; boxes are relative to it.
/// threads  those of the caller's task arena.
std::vector<NodeMoments> sum_moments(const MeshStore& mesh, const Point& centre,
                                     const std::vector<MortonKey>& keys, const WideTree& tree);

}  // namespace planetree::octree
