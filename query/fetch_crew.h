#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "planetree/error.h"
#include "query/fetch_worker.h"
#include "query/model_state.h"

namespace planetree::query {

/// A model's fetch threads, a FetchWorker each. Nobody wakes them, for that would call the
/// system on the asking thread: they look for wishes, often while there have been some lately.
class FetchCrew {
 public:
  /// What a thread takes besides its probe: its stack, as far as it is used.
  static constexpr std::uint64_t kThreadBytes = 65536;

  /// errors  kNoMemory.
  static Result<std::unique_ptr<FetchCrew>> start(const ModelState& model, unsigned threads);
  /// Waits for the page being read.
  ~FetchCrew();

  /// Any thread; waits for nobody.
  std::uint64_t wishes_fetched() const noexcept {
    return wishes_fetched_.load(std::memory_order_relaxed);
  }
  std::uint64_t places_prefetched() const noexcept {
    return places_prefetched_.load(std::memory_order_relaxed);
  }

 private:
  FetchCrew() = default;
  void run(FetchWorker& worker) noexcept;
  void sleep(bool lately);

  std::vector<std::unique_ptr<FetchWorker>> workers_;
  std::vector<std::thread> threads_;
  std::atomic<bool> stopping_{false};
  std::mutex mutex_;
  std::condition_variable stopped_;
  std::atomic<std::uint64_t> wishes_fetched_{0};
  std::atomic<std::uint64_t> places_prefetched_{0};
};

}  // namespace planetree::query
