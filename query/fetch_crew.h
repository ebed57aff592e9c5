#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "planetree/error.h"
#include "query/model_state.h"
#include "query/probe_state.h"

namespace planetree::query {

/// Threads that get for a model's probes what they miss (Wait::kNever) and what they are
/// moving to: each asks the same question again with a probe that waits for pages, which makes
/// all resident that the answer needs, from the root down.
///
/// Nobody wakes them, for that would call the system on the asking thread: they look for
/// wishes, often while there have been some lately.
class FetchCrew {
 public:
  /// What a thread takes besides its probe: its stack, as far as it is used.
  static constexpr std::uint64_t kThreadBytes = 65536;

  /// errors  kNoMemory.
  static Result<std::unique_ptr<FetchCrew>> start(const ModelState& model, unsigned threads);
  /// Waits for the pages being read.
  ~FetchCrew();

  /// Any thread; waits for nobody.
  std::uint64_t wishes_fetched() const noexcept {
    return wishes_fetched_.load(std::memory_order_relaxed);
  }
  std::uint64_t places_prefetched() const noexcept {
    return places_prefetched_.load(std::memory_order_relaxed);
  }

 private:
  class Worker;

  explicit FetchCrew(const ModelState& model);
  void sleep(bool lately);

  const ModelState& model_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<std::thread> threads_;
  std::atomic<bool> stopping_{false};
  std::mutex mutex_;
  std::condition_variable stopped_;
  std::atomic<std::uint64_t> wishes_fetched_{0};
  std::atomic<std::uint64_t> places_prefetched_{0};
};

}  // namespace planetree::query
