#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "planetree/error.h"
#include "planetree/export.h"
#include "planetree/stats.h"
#include "planetree/trace.h"

namespace planetree {

namespace query {
class ModelState;
}

/// Whether to lock in memory what real-time queries touch (frames, cache tables, query arena), so
/// that the system does not page it out.
enum class Locking : std::uint8_t {
  kTry,      ///< lock what the system allows; see Stats::locked_bytes
  kRequire,  ///< lock all of it, or fail to open with kNoMemory
  kNever,    ///< lock nothing
};

/// Options of Model::open.
struct OpenOptions {
  /// Maximum memory in bytes that the model and its probes hold. Frames are claimed at open: for
  /// all pages of the model if they fit, else for as many as fit. Open fails with kNoMemory below
  /// the minimum, which the error names. Memory does not grow beyond the budget after open: the
  /// buffers of future probes and 8 KiB for each io_uring ring (see wait_limit_ms) are reserved.
  std::uint64_t memory_budget_bytes = std::uint64_t{256} << 20;
  /// Number of fetch threads, 1 to kMaxFetchThreads. They read the pages that real-time queries
  /// missed, the pages towards which probes move, and the pages that blocking queries did not get
  /// from the disk within 20 ms. They start at open, with SCHED_OTHER and all signals blocked,
  /// also where the caller is a real-time thread. Each serves some of the probes and reads one
  /// page at a time.
  unsigned fetch_threads = 1;
  /// Number of threads that answer one batch (Probe::closest_points and contains over spans),
  /// including the caller's; 1 to kMaxBatchThreads. Their probes are claimed at open. They serve
  /// one batch at a time; a batch that finds them busy runs on its caller's thread alone.
  unsigned batch_threads = 1;

  /// Maximum number of probes at one time, 1 to kMaxProbes. Each takes memory of the budget.
  unsigned max_probes = 16;
  Locking locking = Locking::kTry;  ///< whether memory is locked at open
  /// Capacity of each probe's page trace, in accesses, up to kMaxPageTraceCapacity; see
  /// Model::drain_page_trace. Rounded up to a power of two of 16 bytes each. 0 records nothing.
  std::uint32_t page_trace_capacity = 0;

  /// Maximum time in milliseconds that a blocking query (Wait::kForPages) waits for a fetch thread
  /// to read one page. Before that the query waits for the disk itself, for the same time but at
  /// most 20 ms. It does so with an io_uring ring; the first 16 probes that need a ring have one
  /// each, with a file descriptor. A probe without a ring polls for 0.3 ms instead.
  /// After the limit the query waits for no other page and ends as kDegraded with an interval that
  /// holds. The next query tries again.
  /// Opening and closing a model have no such limit: they wait for as long as the disk takes.
  unsigned wait_limit_ms = 10'000;

  static constexpr unsigned kMaxProbes = 1024;       ///< limit of `max_probes`
  static constexpr unsigned kMaxFetchThreads = 64;   ///< limit of `fetch_threads`
  static constexpr unsigned kMaxBatchThreads = 256;  ///< limit of `batch_threads`
  /// Limit of `page_trace_capacity`.
  static constexpr std::uint32_t kMaxPageTraceCapacity = std::uint32_t{1} << 24;
};

/// An opened .ptree file. Immutable and shared by any number of threads, each with a Probe of its
/// own. Movable; its probes stay valid when it is moved. Must outlive its probes.
class PLANETREE_API Model {
 public:
  /// Opens and checks a file, claims and locks the memory, loads the root page, makes the side
  /// grid from the upper cells of the mask if there is one, and starts the threads.
  ///
  /// errors   kNotFound, kPermission, kReadFailed: the file cannot be read. kNotPlanetree,
  ///          kUnsupported, kTruncated, kDamaged: its content is refused. kUnsupported also where
  ///          compiler options or the processor change floating-point results. kNoMemory: the
  ///          budget is too small (the text names the minimum), memory cannot be locked, or the
  ///          system refuses memory or threads. kBadArgument: an option is out of range.
  /// threads  any. Allocates, calls the system and waits for the disk.
  [[nodiscard]] static Result<Model> open(const std::filesystem::path& path,
                                          const OpenOptions& options = {});

  /// Takes over the file of another model, which may then only be assigned to or destroyed.
  Model(Model&&) noexcept;
  /// Closes this model, as the destructor does, and takes over the file of another one.
  Model& operator=(Model&&) noexcept;
  /// Ends the model's threads and releases the file and the memory. Waits for the pages that are
  /// being read, without limit. No probe of the model may exist.
  ~Model();

  /// Contents of the file. Valid as long as the model is open.
  ///
  /// threads  any.
  const ModelInfo& info() const noexcept;
  /// State and counters.
  ///
  /// threads  any; takes no lock. Not for real-time threads: reads memory that is not locked.
  Stats stats() const noexcept;
  /// Moves accesses from the page trace to `accesses`, probe by probe, each probe's oldest first.
  /// With an OpenOptions::page_trace_capacity above 0 every real-time query records its page
  /// lookups. It drops those that find the trace of its probe full, because no query waits;
  /// Stats::page_trace_dropped counts them.
  ///
  /// return   number of accesses written: fewer than accesses.size() if the trace is then empty.
  /// threads  any, one at a time; takes no lock.
  std::size_t drain_page_trace(std::span<PageAccess> accesses) const noexcept;

 private:
  friend class Probe;
  friend class query::ModelState;
  explicit Model(std::unique_ptr<query::ModelState> state) noexcept;
  std::unique_ptr<query::ModelState> state_;
};

}  // namespace planetree
