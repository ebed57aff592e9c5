#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <thread>
#include <vector>

#include "cache/page_cache.h"
#include "planetree/error.h"
#include "query/serve/fetch_worker.h"

namespace planetree::query {

/// A model's fetch threads, a FetchWorker each. Queries that wait for pages wake them. Those that
/// do not wait cannot, for that would call the system: so the threads look for wishes, often while
/// there have been some lately.
class FetchThreads {
 public:
  /// What a thread takes besides its probe: its stack, as far as it is used.
  static constexpr std::uint64_t kThreadBytes = 65536;

  /// errors  kNoMemory.
  ///
  /// requests  those of all probes; must outlive this, as must `cache`.
  /// probes    one a thread.
  static Result<std::unique_ptr<FetchThreads>> start(
      cache::PageCache& cache, std::span<FetchRequests> requests,
      std::vector<std::unique_ptr<FetchProbe>> probes);
  /// Waits for the page being read.
  ~FetchThreads();

  /// Any thread; waits for nobody.
  std::uint64_t fetch_requests_served() const noexcept {
    return requests_served_.load(std::memory_order_relaxed);
  }
  std::uint64_t positions_prefetched() const noexcept {
    return positions_prefetched_.load(std::memory_order_relaxed);
  }

 private:
  explicit FetchThreads(cache::PageCache& cache) : cache_(cache) {}
  void run(FetchWorker& worker) noexcept;

  cache::PageCache& cache_;
  std::vector<std::unique_ptr<FetchWorker>> workers_;
  std::vector<std::thread> threads_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::uint64_t> requests_served_{0};
  std::atomic<std::uint64_t> positions_prefetched_{0};
};

}  // namespace planetree::query
