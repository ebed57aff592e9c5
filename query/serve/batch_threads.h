#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

#include <tbb/task_arena.h>

#include "planetree/error.h"

namespace planetree::query {

/// Threads that answer a batch together. The threads are oneTBB's; the caller's is one of them.
class BatchThreads {
 public:
  /// errors  kNoMemory.
  static Result<std::unique_ptr<BatchThreads>> create(unsigned threads);

  /// Answers the queries [first, end) of a batch. `thread` is below the number of threads; no two
  /// calls at one time have the same.
  using Work = void (*)(const void* batch, std::size_t thread, std::size_t first,
                        std::size_t end) noexcept;

  /// Calls `work` for pieces of [0, count) until all are done. Returns false if the threads are
  /// busy with another batch, or oneTBB has no memory: then the caller has to do all the work.
  ///
  /// threads  any, at the same time.
  bool run(const void* batch, std::size_t count, Work work) noexcept;

 private:
  explicit BatchThreads(unsigned threads) : arena_(static_cast<int>(threads)) {}

  tbb::task_arena arena_;
  std::atomic<bool> busy_{false};
};

}  // namespace planetree::query
