#pragma once

#include <cstdint>

#include "octree/geometry/child_bounds.h"
#include "octree/page/frame.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/nearby_subtrees.h"

/// Which of a node's children, or of the subtrees of a list, are where.
namespace planetree::octree {

/// A bit for each whose box meets a box.
unsigned children_meeting(const Node& node, const FloatBox& box) noexcept;
std::uint64_t subtrees_meeting(const NearbySubtrees& list, const FloatBox& box) noexcept;

/// Adds those of a node's children to a list that has room whose boxes are not farther from the
/// query than a threshold, see prune_threshold().
void add_children_within(const Node& node, const FloatQuery& query, float threshold,
                         NearbySubtrees& list) noexcept;

}  // namespace planetree::octree
