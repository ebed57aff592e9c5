#pragma once

#include <vector>

#include "octree/build/mesh_store.h"
#include "octree/build/morton_order.h"
#include "octree/build/wide_tree.h"

namespace planetree::octree {

/// Gives every child of every node its bounding planes: a slab across the surface's
/// area-weighted mean normal and the slab's tangential extent, rounded outward to what is
/// stored.
///
/// "Out-of-core real-time haptic interaction on very large models", section 3, takes planes
/// parallel to faces; the mean's hold rough surfaces tighter (bench/README.md). Subtrees of
/// up to 2^16 triangles are enclosed vertex by vertex, larger ones by the boxes two levels
/// below them.
///
/// centre  of the model; boxes are relative to it.
/// Uses the calling thread's TBB arena; the result depends on the input alone.
void fit_discs(const MeshStore& mesh, const Point& centre, const std::vector<MortonKey>& keys,
               WideTree& tree);

}  // namespace planetree::octree
