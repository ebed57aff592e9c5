#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "planetree/error.h"

namespace planetree::query {

/// Threads that run the queries of a batch together. They are threads of oneTBB and the caller's.
class BatchThreads {
 public:
  /// threads  number of threads, with the caller's
  /// errors   kNoMemory
  static Result<std::unique_ptr<BatchThreads>> create(unsigned threads);

  /// Runs the queries [first, end) of a batch. `thread` is below the number of threads and differs
  /// between calls that run at the same time. `batch` is the argument of run().
  using Work = void (*)(const void* batch, std::size_t thread, std::size_t first,
                        std::size_t end) noexcept;

  /// Calls `work` for pieces of [0, count) until all are done. Returns false if the threads are
  /// busy with another batch or oneTBB has no memory. The caller must then do all the work itself.
  ///
  /// threads  any, at the same time
  bool run(const void* batch, std::size_t count, Work work) noexcept;

 private:
  explicit BatchThreads(unsigned threads);

  // Declared first: the arena may not ask for more threads than oneTBB allows.
  std::optional<tbb::global_control> limit_;
  tbb::task_arena arena_;
  std::atomic<bool> busy_{false};
};

}  // namespace planetree::query
