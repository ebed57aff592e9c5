#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include "planetree/types.h"
#include "query/probe_state.h"

namespace planetree::query {

/// Whether an ask makes sense but for the query, by bits: nothing is computed with doubles. False
/// for some that do, too.
inline bool is_valid_fast(const QueryOptions& options) noexcept {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  const std::uint64_t infinite = bits(std::numeric_limits<double>::infinity());
  return bits(options.max_error) < infinite && bits(options.max_distance) <= infinite &&
         (options.parts & ~kAllParts) == 0;
}

/// What contains() would answer, if a look at what is known of the place is enough, as it is for
/// most points; else kUnknown, as where it was not enough the last time: contains() looks, too.
/// Computes nothing with doubles: the thread may round as it likes, and trap.
inline Containment contains_fast(ProbeState& probe, const Vec3& query,
                                 const QueryOptions& options) noexcept {
  if (!probe.side_grid_answered() || !is_valid_fast(options)) return {};
  const int winding = probe.model().side_grid().find_fast(query.x, query.y, query.z);
  if (winding == octree::SideGrid::kUnknown) return {};
  probe.last_parts() = kSide;
  probe.touches().begin_query(options.wait);
  return {winding != 0 ? Side::kInside : Side::kOutside, Status::kExact};
}

/// See Probe::contains.
Containment contains(ProbeState& probe, const Vec3& query, const QueryOptions& options) noexcept;

}  // namespace planetree::query
