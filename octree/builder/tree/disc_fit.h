#pragma once

#include <vector>

#include "octree/builder/sort/morton_order.h"
#include "octree/builder/sort/triangles.h"
#include "octree/builder/tree/chunk_vertices.h"
#include "octree/builder/tree/wide_tree.h"

namespace planetree::octree {

/// Fits the disc of every child of every node: a slab across the area-weighted mean normal of the
/// child's surface, and the tangential extent of the slab. Both are rounded outward to what is
/// stored.
///
/// "Out-of-core real-time haptic interaction on very large models", section 3, takes planes
/// parallel to faces. Planes across the mean normal enclose rough surfaces more tightly
/// (docs/experiments/blocks.md). Subtrees of up to 2^16 triangles are enclosed vertex by vertex,
/// larger ones by the boxes two levels below them.
///
/// vertices  those of the triangles, with the blocks listed.
/// centre    centre of the model; boxes are relative to it.
void fit_discs(const Triangles& mesh, const ChunkVertices& vertices, const Point& centre,
               const std::vector<MortonKey>& keys, WideTree& tree);

/// Twice a triangle's area times its unit normal.
Point area_vector(const Triangle& triangle);

/// The unit normal of a sum of area vectors; any unit vector where they cancel out.
Point normal_of(const Point& area);

/// Fits the disc of one child.
///
/// boxes  enclose its surface; relative to the model's centre.
void fit_disc(WideChild& child, const Point& normal, const std::vector<FloatBox>& boxes);

/// The boxes two levels below a node; below a child that is a block, the child's own box.
std::vector<FloatBox> boxes_below(const WideTree& tree, const WideNode& node);

}  // namespace planetree::octree
