#include "query/answer/containment.h"

#include "octree/geometry/strict_math.h"
#include "query/answer/query_rules.h"

namespace planetree::query {

SideResult find_containment(const QueryContext& context, const Vec3& query,
                            const octree::Point& scaled, const octree::SideGrid::Lookup& lookup,
                            const QueryOptions& options) noexcept {
  const ModelGeometry& model = context.model;
  // Decided for the query itself: within_reach() may move it beyond another wall of a region.
  if (is_far(scaled))
    if (const auto known = side_without_pages(model, scaled, lookup)) return *known;
  const octree::Point point = within_reach(scaled, query);
  octree::TraversalStats work;
  if (may_use_coherence(context.coherence, options))
    return find_side(model, point, lookup, 0, context.coherence.side, options.max_work,
                     context.pages, work);
  return find_side(model, point, options.max_work, context.pages, work);
}

}  // namespace planetree::query
