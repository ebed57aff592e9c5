#pragma once

#include <limits>

#include "octree/nearest/best_triangle.h"
#include "octree/nearest/nearest.h"

namespace planetree::octree {

/// Least bounds of the subtrees that a traversal skipped; infinity where it skipped none.
struct SkippedBounds {
  /// Least squared bound of the children above the pruning threshold, which max_error lowers.
  float pruned = std::numeric_limits<float>::infinity();
  /// Least squared bound of the children whose page was missing or for which no work was left.
  float unread = std::numeric_limits<float>::infinity();
  /// Some subtree whose page was missing has surface within this distance.
  double within = std::numeric_limits<double>::infinity();
};

/// Makes the answer of a finished traversal.
NearestAnswer finalize(const TreeInfo& tree, const Point& query, const NearestLimits& limits,
                       const BestTriangle& best, const FloatQuery& float_query,
                       const SkippedBounds& skipped) noexcept;

}  // namespace planetree::octree
