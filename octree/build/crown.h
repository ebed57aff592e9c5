#pragma once

#include <cstdint>
#include <vector>

#include "octree/build/page_plan.h"
#include "octree/build/patch_build.h"
#include "octree/build/patches.h"
#include "octree/build/wide_tree.h"
#include "octree/frame.h"

namespace planetree::octree {

/// The tree above the patches. Its blocks stand for the patches, by their numbers; of a model
/// of one patch it has no nodes.
struct Crown {
  WideTree tree;
  PagePlan plan;  ///< pages without their final numbers, parents first; no links
};

/// Makes the tree above patches that were built.
///
/// patches  as above.patches, at least one.
Crown build_crown(const PatchTree& above, const std::vector<BuiltPatch>& patches,
                  const BlockShape& shape, std::uint32_t page_bytes);

}  // namespace planetree::octree
