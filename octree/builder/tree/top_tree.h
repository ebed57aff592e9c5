#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/sort/chunks.h"
#include "octree/builder/tree/chunk_build.h"
#include "octree/builder/tree/page_plan.h"
#include "octree/builder/tree/wide_tree.h"
#include "octree/page/frame.h"

namespace planetree::octree {

/// The tree above the patches. Its blocks stand for the patches, by their numbers; of a model
/// of one patch it has no nodes.
struct TopTree {
  WideTree tree;
  PagePlan plan;  ///< pages without their final numbers, parents first; no links
};

/// Makes the tree above patches that were built.
///
/// patches  as above.patches, at least one.
TopTree build_top_tree(const ChunkTree& above, const std::vector<BuiltChunk>& chunks,
                       const BlockShape& shape, std::uint32_t page_bytes);

}  // namespace planetree::octree
