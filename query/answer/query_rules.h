#pragma once

#include <algorithm>
#include <cmath>

#include "octree/nearest/nearest.h"
#include "planetree/types.h"
#include "query/answer/query_context.h"

/// Rules that queries of all kinds keep to.
namespace planetree::query {

/// Whether a query can be answered at all; if not, its status is kBadQuery.
inline bool is_valid(const Vec3& query, const QueryOptions& options) {
  return std::isfinite(query.x) && std::isfinite(query.y) && std::isfinite(query.z) &&
         options.max_error >= 0 && std::isfinite(options.max_error) && options.max_distance >= 0 &&
         (options.parts & ~kAllParts) == 0;
}

/// Whether a point is beyond octree::kFarthestQuery, or not finite.
inline bool is_far(const octree::Point& point) {
  return !(point.cwiseAbs().maxCoeff() <= octree::kFarthestQuery);
}

/// The query in the model frame, `scaled`, or if that is far, a point in the same direction at
/// octree::kFarthestQuery.
inline octree::Point within_reach(const octree::Point& scaled, const Vec3& query) {
  if (!is_far(scaled)) return scaled;
  const octree::Point from(query.x, query.y, query.z);
  return from / from.cwiseAbs().maxCoeff() * octree::kFarthestQuery;
}

/// The options with the default limit of work filled in.
inline QueryOptions with_defaults(QueryOptions options) {
  if (options.wait == Wait::kNever && options.max_work == QueryOptions::kNoLimit)
    options.max_work = QueryOptions::kRealTimeWork;
  return options;
}

/// Whether a query may start from what the probe kept. An answer of limited work depends on the
/// nodes visited first, so a blocking query of limited work starts from the root. An answer that
/// does not wait depends on what is resident in any case.
inline bool may_use_coherence(const Coherence& coherence, const QueryOptions& options) {
  return coherence.is_on &&
         (options.wait == Wait::kNever || options.max_work == QueryOptions::kNoLimit);
}

/// The parts that are computed: a normal needs the others.
inline std::uint32_t computed_parts(std::uint32_t parts) {
  return (parts & kNormal) != 0 ? kAllParts : parts;
}

}  // namespace planetree::query
