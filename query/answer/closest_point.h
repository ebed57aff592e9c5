#pragma once

#include <limits>

#include "planetree/types.h"
#include "query/answer/query_context.h"

namespace planetree::query {

/// Returns the answer of a query that reached no triangle: `distance` and `upper` are infinite.
inline ClosestPoint unanswered(Status status) noexcept {
  ClosestPoint answer;
  answer.distance = answer.upper = std::numeric_limits<double>::infinity();
  answer.status = status;
  return answer;
}

/// Computes the requested parts of a closest-point query.
///
/// query    model units; is_valid() holds
/// options  returned by with_defaults()
/// answer   unanswered(kExact) at the call; receives the answer
/// side     receives the side if it is a part besides the distance; may be null
/// return   whether a part is not exact because pages were missing or the work was spent
bool closest_point(const QueryContext& context, const Vec3& query, const QueryOptions& options,
                   ClosestPoint& answer, SideResult* side = nullptr) noexcept;

}  // namespace planetree::query
