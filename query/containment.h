#pragma once

#include "planetree/types.h"
#include "query/probe_state.h"

namespace planetree::query {

/// What contains() would answer, if a look at what is known of the place is enough, as it is for
/// most points; else kUnknown. Computes nothing with doubles: the thread may round as it likes,
/// and trap.
Containment contains_at_a_glance(ProbeState& probe, const Vec3& query, const Ask& ask) noexcept;

/// The answer of an ask that contains_at_a_glance() has just been given and did not answer.
Containment contains_after_glance(ProbeState& probe, const Vec3& query, const Ask& ask) noexcept;

/// See Probe::contains.
Containment contains(ProbeState& probe, const Vec3& query, const Ask& ask) noexcept;

}  // namespace planetree::query
