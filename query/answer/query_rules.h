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
inline bool makes_sense(const Vec3& query, const Ask& ask) {
  return std::isfinite(query.x) && std::isfinite(query.y) && std::isfinite(query.z) &&
         ask.max_error >= 0 && std::isfinite(ask.max_error) && ask.max_distance >= 0 &&
         (ask.parts & ~kAllParts) == 0;
}

/// Beyond octree::kFarthestQuery, or no number.
inline bool is_far(const octree::Point& point) {
  return !(point.cwiseAbs().maxCoeff() <= octree::kFarthestQuery);
}

/// The point itself, or one that far away in its direction. `placed` is the query in the
/// model frame.
inline octree::Point within_reach(const octree::Point& placed, const Vec3& query) {
  if (!is_far(placed)) return placed;
  const octree::Point from(query.x, query.y, query.z);
  return from / from.cwiseAbs().maxCoeff() * octree::kFarthestQuery;
}

/// What an ask comes to where it leaves things open.
inline Ask with_defaults(Ask ask) {
  if (ask.wait == Wait::kNever && ask.max_nodes == Ask::kNoLimit)
    ask.max_nodes = Ask::kRealTimeNodes;
  return ask;
}

/// Answers of limited work depend on the way that is taken, so that asks that wait for pages
/// take the one from the root then. What is resident, answers that do not wait depend on anyway.
inline bool may_remember(const Ask& ask) {
  return ask.wait == Wait::kNever || ask.max_nodes == Ask::kNoLimit;
}

/// `clear`: no surface is nearer to the point.
inline Standing side_of(ProbeState& probe, const octree::Point& point,
                        const octree::ColourMap::Spot& spot, double clear, bool remember,
                        std::uint64_t max_nodes, PageTurner& turner, octree::TreeWork& work) {
  if (remember)
    return find_side(probe.model(), point, spot, clear, probe.side_memory(), max_nodes,
                     turner.pages(), work);
  return find_side(probe.model(), point, max_nodes, turner.pages(), work);
}

/// An ask that lost something for want of pages or work.
inline void note_loss(ProbeState& probe, const Vec3& query, const Ask& ask,
                      const PageTurner& turner) {
  if (turner.missed())
    probe.wishes().missed.give({query, ask.max_error, ask.max_distance, ask.max_nodes, ask.parts});
}

}  // namespace planetree::query
