#pragma once

#include <cstdint>

#include "octree/bounds.h"
#include "octree/child_bounds.h"
#include "octree/frame.h"
#include "octree/nearby_subtrees.h"

/// Which of a node's children, or of the subtrees of a list, are where: a bit for each.
namespace planetree::octree {

/// Those whose boxes meet a box.
unsigned children_meeting(const Node& node, const FloatBox& box) noexcept;
std::uint64_t subtrees_meeting(const NearbySubtrees& list, const FloatBox& box) noexcept;

/// Those whose boxes are not farther from the query than a threshold, see prune_threshold().
unsigned children_within(const Node& node, const FloatQuery& query, float threshold) noexcept;

}  // namespace planetree::octree
