#include "query/answer/containment.h"

#include "octree/geometry/strict_math.h"
#include "query/answer/query_rules.h"

namespace planetree::query {
namespace {

// Apart from what most asks come to, which needs few registers.
[[gnu::noinline]] Containment find_containment(ProbeState& probe, const Vec3& query,
                                               const QueryOptions& options,
                                               const octree::Point& scaled,
                                               const octree::SideGrid::Lookup& lookup,
                                               PageTraceWriter* log) {
  // What stands for a point that far away may be beyond another wall of a region.
  if (is_far(scaled))
    if (const auto known = side_without_pages(probe.model(), scaled, lookup))
      return {known->side, known->status};
  const QueryOptions limited = with_defaults(options);
  PageAccessor accessor(probe.reader(), options.wait, probe.model().query_terms());
  accessor.set_trace(log);
  octree::TraversalStats work;
  const SideResult side_result =
      side_of(probe, within_reach(scaled, query), lookup, 0, may_use_coherence(options),
              limited.max_work, accessor, work);
  if (side_result.status == Status::kDegraded) {
    QueryOptions side_alone = limited;
    side_alone.parts = kSide;
    note_loss(probe, query, side_alone, accessor);
    probe.model().count_degraded();
  }
  return {side_result.side, side_result.status};
}

}  // namespace

Containment contains(ProbeState& probe, const Vec3& query, const QueryOptions& options) noexcept {
  if (!is_valid(query, options)) return {};
  const octree::Point scaled = probe.model().scale().in(query);
  probe.last_parts() = kSide;
  PageTraceWriter* const log = probe.touches().begin_query(options.wait);
  const octree::SideGrid::Lookup lookup =
      look_up_side_grid(probe.model(), scaled, frames_of(probe.reader()));
  // What most asks come to.
  probe.side_grid_answered() = lookup.winding != octree::SideGrid::kUnknown;
  if (probe.side_grid_answered())
    return {lookup.winding != 0 ? Side::kInside : Side::kOutside, Status::kExact};
  return find_containment(probe, query, options, scaled, lookup, log);
}

}  // namespace planetree::query
