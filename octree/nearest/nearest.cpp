#include "octree/nearest/nearest.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/nearest/nearest.cpp"
#include <hwy/foreach_target.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>

#include "octree/geometry/strict_math.h"
#include "octree/geometry/work_limit.h"
#include "octree/nearest/best_triangle.h"
#include "octree/nearest/coherence_cache.h"
#include "octree/nearest/nearby_kernels-inl.h"
#include "octree/nearest/nearest_traversal-inl.h"
#include "octree/traversal/bounds.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

std::uint64_t units_of(const NearestLimits& limits) {
  return limits.max_work == std::numeric_limits<std::uint32_t>::max() ? WorkLimit::kNone
                                                                      : limits.max_work;
}

// Finds the nearest triangle in a list of all that may be nearest. None of these is farther than
// `reach` from the list's centre. The answer is not exact if `limit` refuses some of them.
NearestAnswer nearest_of_list(const TreeInfo& tree, const Point& query, const NearestLimits& limits,
                              const NearbyTriangles& list, double reach, WorkLimit& limit,
                              TraversalStats& work) {
  const FloatQuery float_query = FloatQuery::from(query, tree);
  BestTriangle best(float_query, limits, tree.span(query));
  offer_nearby(list, reach, query, float_query, best, limit, work);
  if (limit.exceeded()) [[unlikely]]
    return {};
  limit.take_some(WorkUnits::kNearbyList);
  return finalize(tree, query, limits, best, float_query, {});
}

// Upper bound on the distance from the coarse field; infinity if it tells nothing.
double within(const NearestLimits& limits, const Point& query, CoherenceCache* coherence_cache) {
  if (!limits.field || limits.within < std::numeric_limits<double>::infinity())
    return limits.within;
  const CoarseField::Estimate estimate = limits.field->estimate(query);
  if (coherence_cache) coherence_cache->note_field(estimate);
  return estimate.upper;
}

NearestAnswer nearest_on_target(const TreeInfo& tree, const Point& query,
                                const NearestLimits& limits, const PageReader& pages,
                                TraversalStats& work, CoherenceCache* coherence_cache) {
  WorkLimit limit(work.units, units_of(limits));
  const double reach = coherence_cache ? coherence_cache->reach_of(query) : 0;
  const bool in_ball = coherence_cache && coherence_cache->holds(reach);
  const bool in_list = in_ball && coherence_cache->triangles().complete();
  const auto traverse = [&](bool from_ball) {
    NearestTraversal traversal(tree, query, limits, limit, pages, work);
    from_ball ? traversal.run_from(*coherence_cache)
              : traversal.run_from_root(within(limits, query, coherence_cache));
    if (limits.known) traversal.fall_back_on(*limits.known);
    const NearestAnswer found = finalize(tree, query, limits, traversal.best(),
                                         traversal.float_query(), traversal.skipped_bounds());
    if (found.status == Status::kDegraded) [[unlikely]]
      pages.need_within(traversal.best().exact_threshold());
    return found;
  };
  NearestAnswer answer = in_list ? nearest_of_list(tree, query, limits,
                                                   coherence_cache->triangles(), reach, limit, work)
                                 : traverse(in_ball);
  if (in_list) {
    if (answer.status == Status::kExact) {
      coherence_cache->note(query, answer.point);
      return answer;
    }
    answer = traverse(true);
  }
  if (in_ball) {
    if (answer.status == Status::kExact)
      coherence_cache->note_and_trim(query, answer.distance, answer.point);
    if (answer.status == Status::kExact || limits.known) return answer;
    // Pages are missing, or nothing lies within max_distance. The traversal is repeated from the
    // root, so that the answer is the same as without a cache.
    coherence_cache->forget();
    answer = traverse(false);
  }
  if (coherence_cache && answer.status == Status::kExact) {
    coherence_cache->renew(tree, query, answer.distance, limit, pages, work);
    coherence_cache->note(query, answer.point);
  }
  return answer;
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(nearest_on_target);

static NearestAnswer nearest_in_tree(const TreeInfo& tree, const Point& query,
                                     const NearestLimits& limits, const PageReader& pages,
                                     TraversalStats& work, CoherenceCache* coherence_cache) {
  const bool any_way = limits.may_depend_on_pages();
  return HWY_DYNAMIC_DISPATCH(nearest_on_target)(tree, query, limits, pages, work,
                                                 any_way ? coherence_cache : nullptr);
}

// Answers by the field where that is certain enough, and else by the tree.
[[gnu::noinline]] static NearestAnswer nearest_within_error(
    const TreeInfo& tree, const Point& query, const NearestLimits& limits, const PageReader& pages,
    TraversalStats& work, CoherenceCache* coherence_cache) {
  CoarseField::Estimate estimate = limits.field->estimate(query);
  NearestAnswer answer;
  if (limits.may_be_answered_by(estimate)) {
    if (answer_by_field(query, limits, answer)) return answer;
    estimate.width = answer.upper - answer.lower;
  }
  NearestLimits bounded = limits;
  if (limits.prefers_exact) bounded.max_error = 0;
  bounded.within = estimate.upper;
  answer = nearest_in_tree(tree, query, bounded, pages, work, coherence_cache);
  if (coherence_cache && answer.triangle != kNoTriangle) {
    coherence_cache->note(query, answer.point);
    coherence_cache->note_field(estimate);
  }
  return answer;
}

NearestAnswer nearest(const TreeInfo& tree, const Point& query, const NearestLimits& limits,
                      const PageReader& pages, TraversalStats& work,
                      CoherenceCache* coherence_cache) noexcept {
  assert(query.cwiseAbs().maxCoeff() <= kMaxQueryCoordinate);
  if (limits.max_error > 0 && limits.field)
    return nearest_within_error(tree, query, limits, pages, work, coherence_cache);
  return nearest_in_tree(tree, query, limits, pages, work, coherence_cache);
}

}  // namespace planetree::octree
#endif
