#pragma once

#include <algorithm>
#include <cmath>

#include "octree/nearest/nearest.h"
#include "planetree/types.h"
#include "query/answer/side.h"
#include "query/probe_state.h"
#include "query/serve/pager.h"

/// What asks of all kinds keep to.
namespace planetree::query {

/// Whether it can be answered at all.
inline bool is_valid(const Vec3& query, const QueryOptions& options) {
  return std::isfinite(query.x) && std::isfinite(query.y) && std::isfinite(query.z) &&
         options.max_error >= 0 && std::isfinite(options.max_error) && options.max_distance >= 0 &&
         (options.parts & ~kAllParts) == 0;
}

/// Beyond octree::kFarthestQuery, or no number.
inline bool is_far(const octree::Point& point) {
  return !(point.cwiseAbs().maxCoeff() <= octree::kFarthestQuery);
}

/// The point itself, or one that far away in its direction. `placed` is the query in the
/// model frame.
inline octree::Point within_reach(const octree::Point& scaled, const Vec3& query) {
  if (!is_far(scaled)) return scaled;
  const octree::Point from(query.x, query.y, query.z);
  return from / from.cwiseAbs().maxCoeff() * octree::kFarthestQuery;
}

/// What an ask comes to where it leaves things open.
inline QueryOptions with_defaults(QueryOptions options) {
  if (options.wait == Wait::kNever && options.max_work == QueryOptions::kNoLimit)
    options.max_work = QueryOptions::kRealTimeWork;
  return options;
}

/// Answers of limited work depend on the way that is taken, so that asks that wait for pages
/// take the one from the root then. What is resident, answers that do not wait depend on anyway.
inline bool may_use_coherence(const QueryOptions& options) {
  return options.wait == Wait::kNever || options.max_work == QueryOptions::kNoLimit;
}

/// `clear`: no surface is nearer to the point.
inline SideResult side_of(ProbeState& probe, const octree::Point& point,
                          const octree::SideGrid::Lookup& lookup, double clear, bool remember,
                          std::uint64_t max_work, PageAccessor& accessor,
                          octree::TraversalStats& work) {
  if (remember)
    return find_side(probe.model(), point, lookup, clear, probe.side_cache(), max_work,
                     accessor.pages(), work);
  return find_side(probe.model(), point, max_work, accessor.pages(), work);
}

/// An ask that lost something for want of pages or work.
inline void note_loss(ProbeState& probe, const Vec3& query, const QueryOptions& options,
                      const PageAccessor& accessor) {
  if (accessor.missed())
    probe.fetch_requests().missed.give(
        {query, options.max_error, options.max_distance, options.max_work, options.parts});
}

}  // namespace planetree::query
