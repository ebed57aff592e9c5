#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "planetree/error.h"
#include "planetree/stats.h"
#include "planetree/trace.h"

namespace planetree {

namespace query {
class ModelState;
}

/// Whether to keep the system from paging the arena out.
enum class Locking : std::uint8_t {
  kTry,      ///< if the system allows; Stats says whether it did
  kRequire,  ///< or the model does not open
  kNever,
};

struct OpenOptions {
  /// Hard ceiling for all that the model holds in memory, its probes included.
  /// Claimed at open: the pages of the whole model if they fit, else as many as
  /// do. Nothing grows afterwards but by 8 KiB for each probe that first waits by io_uring (see
  /// wait_limit_ms), which are kept back.
  std::uint64_t memory_budget_bytes = std::uint64_t{256} << 20;
  /// Threads that get what asks of Wait::kNever miss, what probes are moving to, and the pages
  /// of asks that wait where the disk takes longer than 20 ms; 1 to kMaxFetchThreads. Started
  /// at open, as ordinary threads whatever the caller's is. Each serves some of the probes, and
  /// reads one page at a time.
  unsigned fetch_threads = 1;
  /// Threads that answer a batch together (Probe::closest_points over spans), the caller's
  /// among them; 1 to kMaxBatchThreads. Probes for them are claimed at open. One batch at a
  /// time has them: others meanwhile go on in their callers' threads.
  unsigned batch_threads = 1;

  /// Most probes at one time; 1 to kMaxProbes.
  unsigned max_probes = 16;
  Locking locking = Locking::kTry;
  /// Most accesses of pages that wait to be taken, of each probe, up to kMaxPageTraceCapacity; 0:
  /// none are noted. 16 bytes each or, as the next power of two of them are claimed, up to 32.
  std::uint32_t page_trace_capacity = 0;

  /// Longest that an ask of Wait::kForPages waits for a thread to get one page, in milliseconds.
  /// Before that it waits for the disk itself, as long but for no more than 20 ms: by io_uring, of
  /// which the first 16 probes that need one have one each, with a descriptor. Where there is none
  /// it looks for the page again and again instead, for 0.3 ms.
  /// Then it waits for no other, and ends as kDegraded with an interval that holds; the next ask
  /// tries again.
  /// Opening and closing a model wait for as long as the disk takes.
  unsigned wait_limit_ms = 10'000;

  static constexpr unsigned kMaxProbes = 1024;
  static constexpr unsigned kMaxFetchThreads = 64;
  static constexpr unsigned kMaxBatchThreads = 256;
  static constexpr std::uint32_t kMaxPageTraceCapacity = std::uint32_t{1} << 24;
};

/// An opened .ptree file: immutable, shared by any number of threads, each
/// with a Probe of its own. Must outlive its probes.
class Model {
 public:
  /// Opens and checks a file, claims the memory, loads the root and looks at the upper
  /// cells of the mask, if there is one.
  ///
  /// errors  kNotFound, kPermission, kReadFailed; kNotPlanetree, kUnsupported,
  ///         kTruncated, kDamaged; kNoMemory, naming the least budget that will
  ///         do, or because memory cannot be locked; kBadArgument for options that make
  ///         no sense.
  [[nodiscard]] static Result<Model> open(const std::filesystem::path& path,
                                          const OpenOptions& options = {});

  Model(Model&&) noexcept;
  Model& operator=(Model&&) noexcept;
  /// Waits for pages that are being read: while a disk stands still, for that.
  ~Model();

  const ModelInfo& info() const noexcept;
  /// Any thread, at any time; waits for nobody.
  Stats stats() const noexcept;
  /// Takes what asks of Wait::kNever noted of the pages they looked for, where
  /// OpenOptions::page_trace_capacity has them do so: of each probe, the oldest first. Those that
  /// find no room are dropped and counted (Stats::page_trace_dropped), for no ask waits. One thread
  /// at a time, any; waits for nobody. return  how many there were, or room for.
  std::size_t drain_page_trace(std::span<PageAccess> accesses) const noexcept;

 private:
  friend class Probe;
  friend class query::ModelState;
  explicit Model(std::unique_ptr<query::ModelState> state) noexcept;
  std::unique_ptr<query::ModelState> state_;
};

}  // namespace planetree
