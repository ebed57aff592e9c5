#pragma once

#include <atomic>

#include "planetree/types.h"
#include "query/probe_state.h"

namespace planetree::query {

/// See Probe::closest_point.
ClosestPoint closest_point(ProbeState& probe, const Vec3& query,
                           const QueryOptions& options) noexcept;

/// Makes resident what the answer to this ask needs, which waits for pages and is of limited
/// work: from the root down, for what the probe remembers says nothing of what is resident.
/// stop  gives up before the next page that is missing, once true.
void bring_pages(ProbeState& probe, const Vec3& query, const QueryOptions& options,
                 const std::atomic<bool>& stop) noexcept;

}  // namespace planetree::query
