#pragma once

#include <cstdint>
#include <vector>

#include "planetree/eviction_policy.h"
#include "tools/tune/references.h"

namespace planetree::tools {

/// Replays lookups in a cache without pages: it keeps what the engine's cache keeps of its frames,
/// with the engine's own policy classes, and does at each lookup what the engine does for one
/// probe whose queries wait, without fetch threads. So the misses are those of the engine, to the
/// unit.
///
/// frames  at least 2; the root is pinned in one of them
/// return  misses of the lookups that count
std::uint64_t replayed_misses(const References& references, EvictionPolicy policy,
                              std::uint32_t frames);

/// The same for each query.
std::vector<std::uint32_t> replayed_misses_by_query(const References& references,
                                                    EvictionPolicy policy, std::uint32_t frames);

}  // namespace planetree::tools
