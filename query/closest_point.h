#pragma once

#include "planetree/types.h"
#include "query/probe_state.h"

namespace planetree::query {

/// See Probe::closest_point.
ClosestPoint closest_point(ProbeState& probe, const Vec3& query, const Ask& ask) noexcept;

/// See Probe::contains.
Containment contains(ProbeState& probe, const Vec3& query, const Ask& ask) noexcept;

/// Makes resident what the answer to this ask, of limited work, may look at: the probe goes the
/// way that one which was near lately would go.
void bring_pages(ProbeState& probe, const Vec3& query, const Ask& ask) noexcept;

}  // namespace planetree::query
