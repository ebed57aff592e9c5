#pragma once

#include "octree/bounds.h"
#include "octree/child_bounds.h"
#include "octree/frame.h"

/// Which of a node's children are where: a bit for each.
namespace planetree::octree {

/// Those whose boxes meet a box.
unsigned children_meeting(const Node& node, const FloatBox& box) noexcept;

/// Those whose boxes are not farther from the query than a threshold, see prune_threshold().
unsigned children_within(const Node& node, const FloatQuery& query, float threshold) noexcept;

}  // namespace planetree::octree
