#pragma once

#include "octree/best_triangle.h"
#include "octree/nearest.h"

namespace planetree::octree {

/// The answer of a finished descent. `pruned` and `unread` are the least
/// squared float bounds of children left out because the limits allowed it,
/// and because they could not be read or the work was spent.
NearestAnswer conclude(const TreeFacts& tree, const Point& query, const NearestLimits& limits,
                       const BestTriangle& best, const FloatQuery& wide, float pruned,
                       float unread) noexcept;

}  // namespace planetree::octree
