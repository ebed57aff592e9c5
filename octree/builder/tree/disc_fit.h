#pragma once

#include <vector>

#include "octree/builder/sort/morton_order.h"
#include "octree/builder/sort/triangles.h"
#include "octree/builder/tree/chunk_vertices.h"
#include "octree/builder/tree/wide_tree.h"

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
/// vertices  of the triangles, with the blocks' listed.
/// centre    of the model; boxes are relative to it.
void fit_discs(const Triangles& mesh, const ChunkVertices& vertices, const Point& centre,
               const std::vector<MortonKey>& keys, WideTree& tree);

/// Twice a triangle's area times its unit normal.
Point area_vector(const Triangle& triangle);

/// The unit normal of a sum of area vectors; any, where they cancel out.
Point normal_of(const Point& area);

/// Gives one child its bounding planes.
///
/// boxes  hold its surface, relative to the model's centre.
void fit_disc(WideChild& child, const Point& normal, const std::vector<FloatBox>& boxes);

/// The boxes two levels below a node, or one where blocks are.
std::vector<FloatBox> boxes_below(const WideTree& tree, const WideNode& node);

}  // namespace planetree::octree
