#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <thread>
#include <vector>

#include "planetree/error.h"
#include "planetree/model.h"
#include "planetree/trace.h"
#include "tools/trace_file/prefetch_figures.h"
#include "tools/trace_file/trace_header.h"
#include "tools/trace_file/trace_writer.h"

namespace planetree::tools {

/// Facts of a session for the header of its trace file. Those of ticks, of threads and of a
/// simulated disk are left out.
///
/// memory_bytes  budget of the session without the trace
TraceHeader trace_header_of(const Model& model, const std::filesystem::path& file,
                            std::uint64_t memory_bytes, EvictionPolicy policy);

/// Drains a model's page trace to a trace file, and counts what became of prefetched pages.
class TraceRecorder {
 public:
  /// model, writer  must outlive this; the writer has begun
  TraceRecorder(const Model& model, TraceWriter& writer)
      : model_(model), writer_(writer), drained_(4096) {}

  /// Drains the trace now. After a failure it only drains.
  void drain();
  /// Drains the rest and completes the file. Returns the first failure.
  Result<void> finish(std::uint64_t ticks);
  const PrefetchFigures& prefetch() const { return prefetch_; }

 private:
  const Model& model_;
  TraceWriter& writer_;
  std::vector<PageAccess> drained_;
  PrefetchFigures prefetch_;
  Result<void> written_;
};

/// Drains a page trace continuously, on a thread of its own.
class DrainThread {
 public:
  /// Capacity of the page trace that the model should have, in words: more than a probe writes
  /// during several pauses of the thread.
  static constexpr std::uint32_t kTraceWords = std::uint32_t{1} << 16;

  /// Starts the thread. `recorder` must outlive this; only the thread may use it.
  explicit DrainThread(TraceRecorder& recorder);
  /// Ends the thread.
  ~DrainThread();
  DrainThread(const DrainThread&) = delete;
  DrainThread& operator=(const DrainThread&) = delete;

 private:
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace planetree::tools
