#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "cache/page_cache.h"
#include "planetree/error.h"
#include "planetree/eviction_policy.h"
#include "planetree/model.h"
#include "query/file/open_layers.h"
#include "query/serve/page_filler.h"
#include "query/serve/query_arena.h"
#include "storage/file/page_file.h"

namespace planetree::query {

/// Turns page numbers into decoded frames: joins the file, the decoder and the cache. Claims the
/// memory of the model within its budget.
class Pager {
 public:
  struct Limits {
    std::uint64_t budget_bytes = 0;
    OpenLayers opened;
    QueryArena::Needs arena;
    std::uint64_t probe_bytes = 0;  ///< memory of each probe outside of the QueryArena
    unsigned max_probes = 0;
    std::uint64_t thread_bytes = 0;  ///< memory of all the model's threads and their probes
    unsigned thread_probes = 0;      ///< number of probes of the model's threads
    Locking locking = Locking::kTry;
    std::chrono::milliseconds wait_limit{};  ///< longest wait of a query for one page
    bool use_io_uring = true;                ///< OpenOptions::use_io_uring
    EvictionPolicy policy = EvictionPolicy::kClock;
    TimeSource trace_time;  ///< of the page traces

    unsigned readers() const noexcept { return max_probes + thread_probes; }
  };

  /// Claims and locks the memory, reads the root page and pins it.
  ///
  /// file    its FileCalls must outlive this
  /// errors  kDamaged if the root is not on the first page; those of claiming memory and of reading
  ///         a page
  static Result<std::unique_ptr<Pager>> create(storage::PageFile file, const Limits& limits);

  /// Returns the smallest budget that create() accepts. Ignores `limits.budget_bytes`.
  static std::uint64_t min_budget_bytes(const storage::PageFile& file,
                                        const Limits& limits) noexcept;

  const storage::PageFile& file() const noexcept { return file_; }
  const OpenLayers& opened() const noexcept { return opened_; }
  cache::PageCache& cache() const noexcept { return *cache_; }
  /// Memory of the states of model and probes, claimed and locked with the cache's.
  QueryArena& query_arena() noexcept { return *query_arena_; }
  /// The last error of reading a page, if there was one.
  std::optional<Error> read_error() const noexcept { return filler_.read_error(); }
  std::uint64_t locked_bytes() const noexcept {
    return cache_->stats().locked_bytes + (query_arena_is_locked_ ? query_arena_->bytes() : 0);
  }

 private:
  Pager(storage::PageFile file, const OpenLayers& opened)
      : file_(std::move(file)), opened_(opened) {}
  Result<void> claim(const Limits& limits);
  Result<void> lock(Locking locking) noexcept;
  void start_traces(TimeSource time) noexcept;
  static cache::CacheLimits cache_limits(const storage::PageFile& file,
                                         const Limits& limits) noexcept;
  /// pin() is one more than the readers.
  static std::uint64_t fetcher_count(const Limits& limits) noexcept {
    return std::uint64_t{limits.readers()} + 1;
  }
  static PageFiller::Limits filler_limits(const storage::FileHeader& header,
                                          const Limits& limits) noexcept;

  storage::PageFile file_;
  const OpenLayers opened_;
  PageFiller filler_;
  std::unique_ptr<cache::PageCache> cache_;
  std::optional<QueryArena> query_arena_;
  bool query_arena_is_locked_ = false;
};

}  // namespace planetree::query
