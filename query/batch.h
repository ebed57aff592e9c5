#pragma once

#include <span>

#include "planetree/types.h"
#include "query/probe_state.h"

namespace planetree::query {

/// See Probe::closest_points.
void closest_points(ProbeState& probe, std::span<const Vec3> queries,
                    std::span<ClosestPoint> answers, const QueryOptions& options) noexcept;

/// See Probe::contains.
void contains(ProbeState& probe, std::span<const Vec3> queries, std::span<Containment> answers,
              const QueryOptions& options) noexcept;

}  // namespace planetree::query
