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

/// What queries read of an open model beside its pages. It lies in the model's QueryArena, so that
/// a query does not fault a page in.
struct ServingModel {
  ServingModel(const storage::FileHeader& header, cache::PageCache& its_cache,
               const QueryArena::Parts& its_arena)
      : geometry(header), cache(its_cache), arena(its_arena) {}

  ModelGeometry geometry;
  cache::PageCache& cache;
  const QueryArena::Parts arena;
  cache::FetchTerms query_terms{};        ///< how queries wait for pages
  cache::FetchTerms fetcher_terms{};      ///< how fetch threads do
  BatchThreads* batch_threads = nullptr;  ///< null: the caller's thread answers batches alone
  std::span<const std::unique_ptr<ProbeState>> batch_probes;  ///< by thread of batch_threads
  mutable std::atomic<std::uint64_t> degraded{0};             ///< degraded answers

  FetchRequests& requests(std::uint32_t reader) const noexcept {
    return arena.fetch_requests[reader];
  }
  PageTraceWriter page_trace_writer(std::uint32_t reader) const noexcept {
    if (arena.traces.empty()) return {nullptr, nullptr};
    return {&arena.traces[reader], arena.marks.data()};
  }
};

}  // namespace planetree::query
