#pragma once

#include <algorithm>
#include <cmath>

#include "octree/nearest/nearest.h"
#include "planetree/types.h"
#include "query/answer/query_context.h"

/// Rules for all kinds of queries.
namespace planetree::query {

/// Returns whether a query can be answered. If not, its status is kBadQuery.
inline bool is_valid(const Vec3& query, const QueryOptions& options) {
  return std::isfinite(query.x) && std::isfinite(query.y) && std::isfinite(query.z) &&
         options.max_error >= 0 && std::isfinite(options.max_error) && options.max_distance >= 0 &&
         (options.parts & ~kAllParts) == 0;
}

/// Returns whether a coordinate of a point exceeds octree::kFarthestQuery or is not finite.
inline bool is_far(const octree::Point& point) {
  return !(point.cwiseAbs().maxCoeff() <= octree::kFarthestQuery);
}

/// Returns `scaled`, the query in the model frame. If it is far, returns a point in the same
/// direction whose largest coordinate is octree::kFarthestQuery instead.
inline octree::Point within_reach(const octree::Point& scaled, const Vec3& query) {
  if (!is_far(scaled)) return scaled;
  const octree::Point from(query.x, query.y, query.z);
  return from / from.cwiseAbs().maxCoeff() * octree::kFarthestQuery;
}

/// Returns the options with the default work limit of real-time queries filled in.
inline QueryOptions with_defaults(QueryOptions options) {
  if (options.wait == Wait::kNever && options.max_work == QueryOptions::kNoLimit)
    options.max_work = QueryOptions::kRealTimeWork;
  return options;
}

/// Returns whether a query may use the coherence. The answer of a query of limited work depends on
/// which nodes it visits first, so a blocking query of limited work starts from the root. The
/// answer of a real-time query depends on the resident pages in any case.
inline bool may_use_coherence(const Coherence& coherence, const QueryOptions& options) {
  return coherence.is_on &&
         (options.wait == Wait::kNever || options.max_work == QueryOptions::kNoLimit);
}

/// Returns the parts to compute: a normal needs the others.
inline std::uint32_t computed_parts(std::uint32_t parts) {
  return (parts & kNormal) != 0 ? kAllParts : parts;
}

}  // namespace planetree::query
