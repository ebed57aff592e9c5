#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include "planetree/types.h"
#include "query/probe_state.h"

namespace planetree::query {

/// Whether an ask makes sense but for the query, by bits: nothing is computed with doubles. False
/// for some that do, too.
inline bool makes_sense_at_a_glance(const Ask& ask) noexcept {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  const std::uint64_t infinite = bits(std::numeric_limits<double>::infinity());
  return bits(ask.max_error) < infinite && bits(ask.max_distance) <= infinite &&
         (ask.parts & ~kAllParts) == 0;
}

/// What contains() would answer, if a look at what is known of the place is enough, as it is for
/// most points; else kUnknown, as where it was not enough the last time: contains() looks, too.
/// Computes nothing with doubles: the thread may round as it likes, and trap.
inline Containment contains_at_a_glance(ProbeState& probe, const Vec3& query,
                                        const Ask& ask) noexcept {
  if (!probe.colours_told() || !makes_sense_at_a_glance(ask)) return {};
  const int winding = probe.model().colours().glance(query.x, query.y, query.z);
  if (winding == octree::ColourMap::kUnknown) return {};
  probe.last_parts() = kSide;
  probe.touches().begin_ask(ask.wait);
  return {winding != 0 ? Side::kInside : Side::kOutside, Status::kExact};
}

/// See Probe::contains.
Containment contains(ProbeState& probe, const Vec3& query, const Ask& ask) noexcept;

}  // namespace planetree::query
