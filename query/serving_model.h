#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "cache/page_cache.h"
#include "query/answer/model_geometry.h"
#include "query/serve/page_trace.h"
#include "query/serve/query_arena.h"

namespace planetree::query {

class BatchThreads;
class ProbeState;

/// The state of an open model that queries read besides its pages. It lies in the model's
/// QueryArena, so that no query causes a page fault. Any number of threads may read it.
struct ServingModel {
  ServingModel(const storage::FileHeader& header, const OpenLayers& opened,
               cache::PageCache& its_cache, const QueryArena::Parts& its_arena)
      : geometry(header, opened), cache(its_cache), arena(its_arena) {}

  ModelGeometry geometry;
  cache::PageCache& cache;
  const QueryArena::Parts arena;
  cache::FetchTerms query_terms{};        ///< how queries wait for pages
  cache::FetchTerms fetcher_terms{};      ///< how fetch threads wait for pages
  BatchThreads* batch_threads = nullptr;  ///< null: batches run on the caller's thread
  std::span<const std::unique_ptr<ProbeState>> batch_probes;  ///< one per thread of batch_threads
  mutable std::atomic<std::uint64_t> degraded{0};             ///< number of degraded answers
  mutable std::atomic<std::uint64_t> degraded_without_misses{0};  ///< of these, lacking no page

  /// Counts a degraded answer.
  ///
  /// missed  its query lacked a page
  void count_degraded(bool missed) const noexcept {
    degraded.fetch_add(1, std::memory_order_relaxed);
    if (!missed) degraded_without_misses.fetch_add(1, std::memory_order_relaxed);
  }

  /// `reader` is the reader index of a probe.
  FetchRequests& requests(std::uint32_t reader) const noexcept {
    return arena.fetch_requests[reader];
  }
  /// The trace of the probe with this reader index, or null if there is none.
  PageTrace* page_trace(std::uint32_t reader) const noexcept {
    return arena.traces ? &arena.traces->of_readers[reader] : nullptr;
  }
};

}  // namespace planetree::query
