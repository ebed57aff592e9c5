#include "query/answer/containment.h"

#include "octree/geometry/strict_math.h"
#include "query/answer/query_rules.h"

namespace planetree::query {
namespace {

// Apart from what most asks come to, which needs few registers.
[[gnu::noinline]] Containment find_containment(ProbeState& probe, const Vec3& query, const Ask& ask,
                                               const octree::Point& placed,
                                               const octree::ColourMap::Spot& spot, TouchLog* log) {
  // What stands for a point that far away may be beyond another wall of a region.
  if (is_far(placed))
    if (const auto known = side_at_once(probe.model(), placed, spot))
      return {known->side, known->status};
  const Ask limited = with_defaults(ask);
  PageTurner turner(probe.reader(), ask.wait, probe.model().asking_terms());
  turner.log_to(log);
  octree::TreeWork work;
  const Standing standing = side_of(probe, within_reach(placed, query), spot, 0, may_remember(ask),
                                    limited.max_nodes, turner, work);
  if (standing.status == Status::kDegraded) {
    Ask side_alone = limited;
    side_alone.parts = kSide;
    note_loss(probe, query, side_alone, turner);
    probe.model().count_degraded();
  }
  return {standing.side, standing.status};
}

}  // namespace

Containment contains(ProbeState& probe, const Vec3& query, const Ask& ask) noexcept {
  if (!makes_sense(query, ask)) return {};
  const octree::Point placed = probe.model().scale().in(query);
  probe.last_parts() = kSide;
  TouchLog* const log = probe.touches().begin_ask(ask.wait);
  const octree::ColourMap::Spot spot =
      look_at_colours(probe.model(), placed, frames_of(probe.reader()));
  // What most asks come to.
  probe.colours_told() = spot.winding != octree::ColourMap::kUnknown;
  if (probe.colours_told())
    return {spot.winding != 0 ? Side::kInside : Side::kOutside, Status::kExact};
  return find_containment(probe, query, ask, placed, spot, log);
}

}  // namespace planetree::query
