#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/sort/morton_order.h"
#include "octree/builder/sort/triangles.h"
#include "octree/builder/tree/chunk_vertices.h"
#include "octree/builder/tree/wide_tree.h"
#include "octree/page/frame.h"

namespace planetree::octree {

/// Number of slots of each block's record. The vertices of the blocks must have been listed.
std::vector<std::uint8_t> block_slots(const Triangles& triangles, const ChunkVertices& vertices,
                                      const std::vector<MortonKey>& keys,
                                      const std::vector<WideBlock>& blocks,
                                      const BlockShape& shape);

}  // namespace planetree::octree
