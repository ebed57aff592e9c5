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

/// A model's fetch threads, with one FetchWorker each. A blocking query wakes them. A real-time
/// query cannot, because that takes a system call. So the threads poll for fetch requests, more
/// often if they had something to do within the last second.
class FetchThreads {
 public:
  /// Memory of a thread besides its probe: the used part of its stack.
  static constexpr std::uint64_t kThreadBytes = 65536;

  /// Starts one thread for each of `probes`.
  ///
  /// cache     must outlive this
  /// requests  fetch requests of all probes, indexed by reader; must outlive this
  /// errors    kNoMemory
  static Result<std::unique_ptr<FetchThreads>> start(
      cache::PageCache& cache, std::span<FetchRequests> requests,
      std::vector<std::unique_ptr<FetchProbe>> probes);
  /// Stops the threads. Waits for the pages that they are reading.
  ~FetchThreads();

  /// Counters since start(). Any thread may call these; they do not wait.
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
