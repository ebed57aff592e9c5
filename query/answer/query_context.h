#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "octree/geometry/work_limit.h"
#include "octree/nearest/coherence_cache.h"
#include "octree/nearest/nearest.h"
#include "octree/traversal/tree_view.h"
#include "planetree/types.h"
#include "query/answer/model_geometry.h"
#include "query/answer/side.h"

/// Rules for all kinds of queries.
namespace planetree::query {

/// The state that one probe keeps from query to query, because the next query is often nearby. It
/// allocates nothing. One thread at a time may use it. Exact answers have the same bits with and
/// without it; so have all answers of blocking queries of a batch.
struct Coherence {
  /// If false, every query starts from the root, as the first one does. For the queries of fetch
  /// threads that must read all pages on the way, and for tests.
  bool is_on = true;
  /// True while a fetch thread prefetches for a moving probe. Its queries find sides as those of
  /// the moving probe do: by the coherence, where that tells the side, so that no page of the mask
  /// is read in vain.
  bool follows_motion = false;

  octree::CoherenceCache nearest;      ///< subtrees and triangles near the last query
  octree::NearestAnswer last_nearest;  ///< last answer that may serve where pages or work lack
  SideCache side;                      ///< last point of known side; last mask cell
  bool side_grid_answered = true;      ///< the last lookup in the side grid found a side
  bool searched_side = false;          ///< the last closest-point query searched for the side
};

/// The inputs of a query. The code in this folder knows neither threads nor memory; it gets pages
/// through `pages` only.
struct QueryContext {
  const ModelGeometry& model;
  const octree::PageReader& pages;
  Coherence& coherence;
  octree::TraversalStats& work;  ///< counters that the query adds to; zero before it
};

/// Returns whether a query can be answered. If not, its status is kBadQuery.
inline bool is_valid(const Vec3& query, const QueryOptions& options) {
  return std::isfinite(query.x) && std::isfinite(query.y) && std::isfinite(query.z) &&
         options.max_error >= 0 && std::isfinite(options.max_error) && options.max_distance >= 0 &&
         (options.parts & ~kAllParts) == 0 && options.side_rule <= SideRule::kSurface &&
         options.normal_rule <= NormalRule::kTowardQuery;
}

/// Returns whether a coordinate of a point exceeds octree::kMaxQueryCoordinate or is not finite.
inline bool is_far(const octree::Point& point) {
  return !(point.cwiseAbs().maxCoeff() <= octree::kMaxQueryCoordinate);
}

/// Returns `scaled`, the query in the model frame. If it is far, returns a point in the same
/// direction whose largest coordinate is octree::kMaxQueryCoordinate instead.
inline octree::Point within_reach(const octree::Point& scaled, const Vec3& query) {
  if (!is_far(scaled)) return scaled;
  const octree::Point from(query.x, query.y, query.z);
  return from / from.cwiseAbs().maxCoeff() * octree::kMaxQueryCoordinate;
}

/// Returns the options with the default work limit of real-time queries filled in.
inline QueryOptions with_defaults(QueryOptions options) {
  if (options.wait == Wait::kNever && options.max_work == QueryOptions::kNoLimit)
    options.max_work = QueryOptions::kRealTimeWork;
  return options;
}

/// Returns the work limit of options returned by with_defaults().
inline std::uint64_t max_units(const QueryOptions& options) {
  return options.max_work == QueryOptions::kNoLimit ? octree::WorkLimit::kNone : options.max_work;
}

/// Takes work that was spent from the limit of the options, if there is one.
inline void spend(QueryOptions& options, std::uint64_t units) {
  if (options.max_work != QueryOptions::kNoLimit)
    options.max_work -=
        static_cast<std::uint32_t>(std::min<std::uint64_t>(units, options.max_work));
}

/// Returns whether answers that are not exact may depend on earlier queries: those of real-time
/// queries, which depend on the resident pages in any case, and those of limited work, which spend
/// less of it where they start near the last answer. Not in a batch: its order is not the caller's.
inline bool may_remember_inexact(const Coherence& coherence, const QueryOptions& options) {
  return coherence.is_on && !coherence.follows_motion &&
         (options.wait == Wait::kNever ||
          (options.max_work != QueryOptions::kNoLimit &&
           coherence.nearest.course() == octree::CoherenceCache::Course::kPath));
}

/// Returns whether a query may use the coherence. The answer of a query of limited work depends on
/// which nodes it visits first. Nobody uses the answer of a prefetch.
inline bool may_use_coherence(const Coherence& coherence, const QueryOptions& options) {
  return coherence.is_on && (options.max_work == QueryOptions::kNoLimit ||
                             coherence.follows_motion || may_remember_inexact(coherence, options));
}

/// Returns the parts to compute: a normal needs the others.
inline std::uint32_t computed_parts(std::uint32_t parts) {
  return (parts & kNormal) != 0 ? kAllParts : parts;
}

}  // namespace planetree::query
