#include "octree/nearest/nearest.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/nearest/nearest.cpp"
#include <hwy/foreach_target.h>

#include <algorithm>
#include <cassert>

#include "octree/geometry/strict_math.h"
#include "octree/nearest/best_triangle.h"
#include "octree/nearest/coherence_cache.h"
#include "octree/nearest/finalize.h"
#include "octree/nearest/nearby_kernels-inl.h"
#include "octree/nearest/nearest_traversal-inl.h"
#include "octree/traversal/bounds.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

// All triangles that may be nearest are in the list, no farther than `reach` from its centre.
NearestAnswer nearest_of_list(const TreeFacts& tree, const Point& query,
                              const NearestLimits& limits, const NearbyTriangles& list,
                              double reach, TreeWork& work) {
  const FloatQuery wide = FloatQuery::from(query, tree.centre);
  BestTriangle best(wide, limits);
  offer_nearby(list, reach, query, wide, best, work);
  return conclude(tree, query, limits, best, wide, {});
}

NearestAnswer nearest_on_target(const TreeFacts& tree, const Point& query,
                                const NearestLimits& limits, const PageReader& pages,
                                TreeWork& work, Vicinity* vicinity) {
  const std::uint64_t before = work.nodes + work.blocks;
  const double reach = vicinity ? vicinity->reach_of(query) : 0;
  const bool held = vicinity && vicinity->holds(reach);
  const bool listed = held && vicinity->triangles().complete();
  const auto descend = [&](bool from_ball) {
    Descent descent(tree, query, limits, pages, work);
    from_ball ? descent.run_from(*vicinity) : descent.run_from_root();
    if (limits.known) descent.fall_back_on(*limits.known);
    return conclude(tree, query, limits, descent.best(), descent.wide(),
                    descent.what_is_left_out());
  };
  NearestAnswer answer =
      listed ? nearest_of_list(tree, query, limits, vicinity->triangles(), reach, work)
             : descend(held);
  if (listed) {
    if (answer.status == Status::kExact) {
      vicinity->note(query, answer.point);
      return answer;
    }
    answer = descend(true);
  }
  if (held) {
    if (answer.status == Status::kExact) vicinity->outlive(query, answer.distance, answer.point);
    if (answer.status == Status::kExact || limits.known) return answer;
    // Lost pages, or nothing so near as asked: told from the root, as ever.
    vicinity->forget();
    answer = descend(false);
  }
  if (vicinity && answer.status == Status::kExact) {
    const std::uint64_t spent = work.nodes + work.blocks - before;
    const std::uint64_t left = limits.max_nodes - std::min<std::uint64_t>(spent, limits.max_nodes);
    vicinity->renew(tree, query, answer.distance, left, pages, work);
    vicinity->note(query, answer.point);
  }
  return answer;
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(nearest_on_target);

NearestAnswer nearest(const TreeFacts& tree, const Point& query, const NearestLimits& limits,
                      const PageReader& pages, TreeWork& work, Vicinity* vicinity) noexcept {
  assert(query.cwiseAbs().maxCoeff() <= kFarthestQuery);
  const bool any_way = limits.known || limits.allow_any_way();
  return HWY_DYNAMIC_DISPATCH(nearest_on_target)(tree, query, limits, pages, work,
                                                 any_way ? vicinity : nullptr);
}

}  // namespace planetree::octree
#endif
