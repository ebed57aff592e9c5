#pragma once

#include "planetree/types.h"
#include "query/answer/query_context.h"

namespace planetree::query {

/// A ClosestPoint for which no triangle was reached.
ClosestPoint unanswered(Status status) noexcept;

/// Fills in the parts of a closest-point query that are requested.
///
/// query    model units; is_valid().
/// options  with_defaults() applied.
/// answer   unanswered(kExact).
/// return   whether a part is not exact because pages are missing or the work is spent.
bool closest_point(const QueryContext& context, const Vec3& query, const QueryOptions& options,
                   ClosestPoint& answer) noexcept;

}  // namespace planetree::query
