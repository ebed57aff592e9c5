#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include <tbb/task_arena.h>

#include "planetree/error.h"
#include "query/probe_state.h"

namespace planetree::query {

/// Threads that answer a batch together, each with a probe of its own, claimed when the model
/// is opened. The threads are oneTBB's; the caller's is one of them.
class BatchThreads {
 public:
  /// errors  kNoMemory.
  static Result<std::unique_ptr<BatchThreads>> claim(const ModelState& model, unsigned threads);

  /// Queries the queries [first, end) of a batch by way of a probe.
  using Work = void (*)(const void* batch, ProbeState& probe, std::size_t first,
                        std::size_t end) noexcept;

  /// Has the crew do pieces of [0, count) until all is done. False where it is busy with
  /// another batch or cannot work for want of memory: then the caller is to do it all.
  ///
  /// threads  any, at the same time.
  bool run(const void* batch, std::size_t count, Work work) noexcept;

 private:
  explicit BatchThreads(unsigned threads) : arena_(static_cast<int>(threads)) {}

  tbb::task_arena arena_;
  std::vector<std::unique_ptr<ProbeState>> probes_;  // by the thread's place in the arena
  std::atomic<bool> busy_{false};
};

}  // namespace planetree::query
