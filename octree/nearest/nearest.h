#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "octree/geometry/triangle_distance.h"
#include "octree/nearest/coherence_cache.h"
#include "octree/traversal/tree_view.h"
#include "planetree/types.h"

namespace planetree::octree {

/// Farther queries need no descent: coordinates of a model are below 2^55, so
/// that taking them off such a query changes no bit of any squared distance,
/// and the nearest triangle is the one of least index.
inline constexpr double kFarthestQuery = 0x1p300;

/// An answer in the model frame: the nearest point of a triangle, and what is known of others.
struct NearestAnswer : NearestOnTriangle {
  double distance = 0;
  double lower = 0;
  double upper = 0;
  std::uint64_t triangle = kNoTriangle;
  Triangle corners{Point::Zero(), Point::Zero(), Point::Zero()};  ///< of `triangle`
  bool is_height_field = false;  ///< `triangle` is known to be in a sheet (BlockHeader)
  Status status = Status::kBadQuery;
};

/// Limits of one descent; lengths are in the model frame.
struct NearestLimits {
  double max_error = 0;
  double max_distance = std::numeric_limits<double>::infinity();
  std::uint32_t max_work = std::numeric_limits<std::uint32_t>::max();
  /// One with a triangle of this tree, to fall back upon where pages are missing: its
  /// triangle, not its distance, counts. Limited work, too, may then start from what the last
  /// query left, so that answers that are not exact depend on the queries before. May be null.
  const NearestAnswer* known = nullptr;

  /// Whether all ways lead to the same answer. Limited work and errors depend on the way, which
  /// what is resident must not steer, and what was asked before only where there is a `known`.
  bool allow_any_way() const {
    return max_error == 0 && max_work == std::numeric_limits<std::uint32_t>::max();
  }
};

/// Nearest surface point to `query`, by a descent that takes the nearest child first: of the
/// last node near the surface; far from it of all nodes, two at a time; or of each subtree that a
/// ball holds.
///
/// query   model frame, no coordinate beyond kFarthestQuery.
/// return  the triangle of least (value, index), value being that of
///         octree/geometry/triangle_distance.h, so that an exact answer is a function
///         of tree and query alone. [lower, upper] holds the true distance
///         whatever the status. Pages that cannot be had are leaves with a
///         lower bound: the descent goes on elsewhere, and the answer is still
///         kExact where none of them can matter.
/// threads any; no allocation, no lock, no exception of its own.
/// source  descent and float filter are ours; bounds in octree/traversal/bounds.h.
NearestAnswer nearest(const TreeInfo& tree, const Point& query, const NearestLimits& limits,
                      const PageReader& pages, TraversalStats& work,
                      CoherenceCache* coherence_cache = nullptr) noexcept;

}  // namespace planetree::octree
