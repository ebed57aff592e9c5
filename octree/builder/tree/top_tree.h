#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/sort/chunks.h"
#include "octree/builder/tree/chunk_build.h"
#include "octree/builder/tree/page_plan.h"
#include "octree/builder/tree/wide_tree.h"
#include "octree/page/frame.h"

namespace planetree::octree {

/// The tree above the chunks. Its blocks stand for the chunks, by number. It has no nodes if the
/// model is one chunk.
struct TopTree {
  WideTree tree;
  PagePlan plan;  ///< pages without final numbers, parents first; no links
};

/// Builds the tree above the chunks.
///
/// chunks  built from above.chunks; at least one.
TopTree build_top_tree(const ChunkTree& above, const std::vector<BuiltChunk>& chunks,
                       const BlockShape& shape, std::uint32_t page_bytes);

}  // namespace planetree::octree
