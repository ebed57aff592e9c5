#pragma once

#include <limits>

#include "octree/nearest/best_triangle.h"
#include "octree/nearest/nearest.h"

namespace planetree::octree {

/// The children that a descent did not visit.
struct SkippedBounds {
  float pruned = std::numeric_limits<float>::infinity();  ///< least squared bound of those that
                                                          ///< max_error allowed to leave out,
  float unread = std::numeric_limits<float>::infinity();  ///< and of those whose page was not to
                                                          ///< be had, or the work spent
  /// In some of the latter there is surface within this distance.
  double within = std::numeric_limits<double>::infinity();
};

/// The answer of a finished descent.
NearestAnswer finalize(const TreeInfo& tree, const Point& query, const NearestLimits& limits,
                       const BestTriangle& best, const FloatQuery& wide,
                       const SkippedBounds& skipped) noexcept;

}  // namespace planetree::octree
