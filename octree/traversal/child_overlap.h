#pragma once

#include <cstdint>

#include "octree/geometry/child_bounds.h"
#include "octree/page/frame.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/nearby_subtrees.h"

/// Tests of a node's children, or of a list of subtrees, against a box or a query.
namespace planetree::octree {

/// Returns a bit for each child, or subtree, whose box meets `box`.
unsigned children_meeting(const Node& node, const FloatBox& box) noexcept;
std::uint64_t subtrees_meeting(const NearbySubtrees& list, const FloatBox& box) noexcept;

/// Adds to `list` the children of `node` whose boxes are not farther from the query than
/// `threshold` (see prune_threshold()). `list` must have capacity, see
/// NearbySubtrees::has_capacity().
void add_children_within(const Node& node, const FloatQuery& query, float threshold,
                         NearbySubtrees& list) noexcept;

}  // namespace planetree::octree
