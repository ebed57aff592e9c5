#pragma once

#include "cache/page_cache.h"

namespace planetree::query {

/// Copies the counts of a cache to the members of Stats or SceneStats that report them.
template <class AnyStats>
void report_cache(const cache::CacheStats& cache, AnyStats& stats) noexcept {
  stats.page_hits = cache.hits;
  stats.page_misses = cache.misses;
  stats.pages_read = cache.fills;
  stats.pages_evicted = cache.evictions;
  stats.quarantined_pages = cache.quarantined;
  stats.waits_given_up = cache.given_up;
  stats.frames = cache.frame_count;
  stats.arena_bytes = cache.arena_bytes;
  stats.table_bytes = cache.table_bytes + cache.reserved_bytes;
  stats.budget_bytes = cache.budget_bytes;
}

}  // namespace planetree::query
