#pragma once

#include "planetree/types.h"
#include "query/answer/query_context.h"
#include "query/answer/side.h"

namespace planetree::query {

/// Finds the side of a point that the side grid does not decide.
///
/// query    model units; is_valid() holds
/// scaled   the query in the model frame
/// lookup   result of look_up_side_grid() for `scaled`
/// options  returned by with_defaults()
SideResult find_containment(const QueryContext& context, const Vec3& query,
                            const octree::Point& scaled, const octree::SideGrid::Lookup& lookup,
                            const QueryOptions& options) noexcept;

}  // namespace planetree::query
