#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "planetree/attributes.h"
#include "planetree/error.h"
#include "planetree/eviction_policy.h"
#include "planetree/export.h"
#include "planetree/layers.h"
#include "planetree/metadata.h"
#include "planetree/stats.h"
#include "planetree/trace.h"

namespace planetree {

namespace query {
class ModelState;
}

/// Whether to lock the arena in memory, so that the system does not swap it out. The arena is all
/// memory of a model that real-time queries access: frames, cache tables and query arena.
enum class Locking : std::uint8_t {
  kTry,      ///< lock what the system allows; see Stats::locked_bytes
  kRequire,  ///< lock all of it, or fail to open with kNoMemory
  kNever,    ///< lock nothing
};

/// Options of Model::open.
struct OpenOptions {
  /// Budget: maximum memory in bytes of the model, its threads and its probes. Open allocates and
  /// prefaults one frame for each page that queries may read, or as many frames as fit in the
  /// budget. These are the pages of the layers that are opened, without field pages. If the
  /// budget is below the minimum, open fails with kNoMemory, and the error text gives the minimum.
  /// The budget includes page traces, the buffers of all `max_probes` probes, and 8 KiB for each
  /// io_uring ring (see wait_limit_ms). So memory does not grow beyond the budget after open. The
  /// budget does not include memory that oneTBB allocates for batches on several threads.
  std::uint64_t memory_budget_bytes = std::uint64_t{256} << 20;
  /// Number of fetch threads, 1 to kMaxFetchThreads. They read
  ///
  /// - the pages that real-time queries missed,
  /// - the pages near positions predicted from Probe::motion, and
  /// - the pages that blocking queries did not get from the disk within 20 ms.
  ///
  /// They start at open. They run under SCHED_OTHER even if the caller is a real-time thread, and
  /// block all signals. Each fetch thread serves a fixed subset of the probes and reads one page at
  /// a time.
  unsigned fetch_threads = 1;
  /// Whether fetch threads that have nothing else to do read all pages of the opened layers, in the
  /// order of the file. They do so only if memory holds all of them, so that none is ever evicted.
  /// Stats::pages_read_ahead counts the pages.
  bool read_ahead = false;
  /// Number of threads that answer one batch (Probe::closest_points and contains over spans),
  /// including the caller's; 1 to kMaxBatchThreads. If it is above 1, open creates a probe for
  /// each, which does not count towards `max_probes`. The threads serve one batch at a time. A
  /// batch that finds them busy runs on its caller's thread alone.
  unsigned batch_threads = 1;

  /// Maximum number of probes at one time, 1 to kMaxProbes. Open reserves memory of the budget for
  /// all of them.
  unsigned max_probes = 16;
  /// Layers to open: kSideLayer, kFieldLayer and kAttributeLayer, combined with `|`. The distance
  /// layer is always opened. A layer that the file does not have is left out. Of a layer that is
  /// not opened, no page is read, and nothing is allocated or counted towards the budget.
  /// Distances, nearest points and triangles of exact answers have the same bits for all layers.
  ///
  /// Without kSideLayer, a side by SideRule::kSolid is kUnknown: a query whose parts have kSide or
  /// kNormal is kDegraded, and so is Probe::contains. The normal then follows the orientation of
  /// the mesh, unless NormalRule::kTowardQuery is set. Sides by SideRule::kSurface are as always.
  std::uint32_t layers = kAllLayers;
  Locking locking = Locking::kTry;  ///< whether memory is locked at open
  /// How the page to evict is chosen. Answers do not depend on it, the number of pages read does.
  EvictionPolicy policy = EvictionPolicy::kClock;
  /// Capacity of the page trace of each probe and thread, in words of 8 bytes, up to
  /// kMaxPageTraceCapacity; see Model::drain_page_trace. It is rounded up to a power of two. A page
  /// lookup takes a word, a page read or evicted up to 3, a motion up to 9. 0 records nothing.
  std::uint32_t page_trace_capacity = 0;

  /// Wait limit: maximum time in milliseconds that a blocking query (Wait::kForPages) waits for a
  /// fetch thread to read one page. Any value is allowed.
  ///
  /// Before that the query reads the page itself and waits for the disk for at most
  /// min(wait_limit_ms, 20) ms. So a page takes at most about 20 ms more than the limit. The wait
  /// uses an io_uring ring. The first 16 probes that need a ring get one. Each ring takes a file
  /// descriptor. A probe without a ring polls for 0.3 ms instead, and so does every probe if the
  /// limit is 0.
  ///
  /// After the limit the query waits for no other page. Its answer is kDegraded, and its interval
  /// contains the true distance. The next query tries again.
  ///
  /// The limit does not concern opening and closing a model: they wait for as long as the disk
  /// takes.
  unsigned wait_limit_ms = 10'000;

  /// Whether blocking queries may wait by io_uring rings; see wait_limit_ms. Set it to false if a
  /// filter of system calls ends the process instead of refusing the call. A ring that the system
  /// refuses is no error: queries then poll.
  bool use_io_uring = true;

  /// Directory in which a model that is opened by URL keeps what it has read, for later processes.
  /// It is created if need be. Empty: nothing is kept. Any number of models and processes may use
  /// one. A file is there that never exceeds `http_cache_bytes`; it may be removed at any time. For
  /// models of files it does nothing.
  std::filesystem::path http_cache{};
  /// Maximum bytes of the file in `http_cache`, at least 1.1 MB (4 clusters of 256 KiB). A model
  /// that is opened with a lower limit shortens the file.
  std::uint64_t http_cache_bytes = std::uint64_t{1} << 30;

  /// Whether a set may be opened of which members are missing: a part of a large model on a small
  /// machine. Pages of missing members cannot be read: answers that need one are
  /// Status::kDegraded, with intervals that hold, and all others are exact. The first two members
  /// and the last one have to be there. Members on servers are opened when they are first read.
  bool allow_missing_members = false;

  static constexpr unsigned kMaxProbes = 1024;       ///< limit of `max_probes`
  static constexpr unsigned kMaxFetchThreads = 64;   ///< limit of `fetch_threads`
  static constexpr unsigned kMaxBatchThreads = 256;  ///< limit of `batch_threads`
  /// Limit of `page_trace_capacity`.
  static constexpr std::uint32_t kMaxPageTraceCapacity = std::uint32_t{1} << 24;
};

/// An opened .ptree file, or an opened set of files. Its contents do not change. Any number of
/// threads may share a model, each with a Probe of its own. A model can be moved; its probes and
/// the reference that info() returned stay valid. The model, or the one it was moved to, must
/// outlive its probes.
///
/// The files must not be written to or truncated while they are open: pages read later then count
/// as damaged. They may be removed or replaced by others, because the model keeps those that it
/// opened. A process made by fork() must not use the model, because the model's threads do not
/// run there.
class PLANETREE_API Model {
 public:
  /// Opens and checks a file, allocates and locks the memory, reads the root page, and starts the
  /// threads. If the side layer is opened, also reads the upper cells of the mask into the side
  /// grid. If the field layer is opened, also reads the field.
  ///
  /// path     a regular file, or a URL that starts with `http://` or `https://`.
  ///          A name that ends in `.ptreeset` is that of a set file; the members are opened too. A
  ///          server must serve ranges of bytes. Models of sets and of URLs answer as one of the
  ///          single file does, bit for bit. Of a large model on a server, neither the field nor
  ///          the side grid is read at open. The budget then includes 16.5 MiB for clusters and
  ///          connections; of a set, at least 2.5 MiB for each member.
  /// errors   kUnsupported: compiler options or the processor change floating-point results.
  ///          kBadArgument: an option is out of range. Both are found before the file is opened.
  ///          kNotFound, kPermission, kReadFailed: the file or the URL cannot be read.
  ///          kNotPlanetree, kUnsupported, kTruncated, kDamaged: the content of the file is
  ///          refused. kNoMemory: the budget is too small (the text gives the minimum), memory
  ///          cannot be locked, or the system refuses memory or threads. A system without io_uring
  ///          is no error.
  /// threads  any, but not real-time threads: allocates memory, makes system calls and waits for
  ///          the disk.
  [[nodiscard]] static Result<Model> open(const std::filesystem::path& path,
                                          const OpenOptions& options = {});

  /// Moves another model here. That one may then only be assigned to or destroyed.
  Model(Model&&) noexcept;
  /// Closes this model, as the destructor does, and moves another one here.
  Model& operator=(Model&&) noexcept;
  /// Ends the model's threads and releases the file and the memory. Waits without limit for the
  /// pages that its threads are reading. Destroy all probes of the model before.
  ~Model();

  /// Returns the contents of the file. The reference is valid until the model is closed, also after
  /// a move.
  ///
  /// threads  any.
  const ModelInfo& info() const noexcept;
  /// Returns state and counters.
  ///
  /// threads  any, but not real-time threads: it takes no mutex, but it reads memory outside of
  ///          the arena, which the system may have swapped out.
  Stats stats() const noexcept;
  /// Returns the last error of reading a page, with cause, remedy and the URL if there is one.
  /// Empty if every page could be read so far. Answers that lack the page are Status::kDegraded. A
  /// page of a file is not read again. A page that a server did not give is read again when a query
  /// needs it, unless the server has another file by now.
  ///
  /// threads  any, but not real-time threads: takes a mutex.
  std::optional<Error> read_error() const noexcept;
  /// Moves records from the page traces of all probes and threads to `accesses`, in the order of
  /// their times. If OpenOptions::page_trace_capacity is above 0, every query records its page
  /// lookups, and every thread the pages that it reads and evicts. The records of Model::open come
  /// first, or are left out if the capacity is too small for all of them.
  ///
  /// A query records nothing while its trace is full. Stats::page_trace_dropped counts the records
  /// lost. Records of a query that runs appear when it ends, so that a later call may return
  /// records of times before those of an earlier call.
  ///
  /// return   number of records written. If it is less than accesses.size(), the call has emptied
  ///          all traces.
  /// threads  any, but no two at the same time. Takes no mutex, unless the file has more than
  ///          130,560 pages: it then looks pages up in the directory, which it may read.
  std::size_t drain_page_trace(std::span<PageAccess> accesses) const noexcept;

  /// Returns triangles of the mesh by their indices: corners in the order of the mesh, and what the
  /// file keeps of them (ModelInfo::attributes). Reads the pages that are not in memory and waits
  /// for the disk, as a blocking query does. Indices in the order of the mesh, or of answers to
  /// neighbouring points, take the least time.
  ///
  /// indices    as ClosestPoint::triangle has them.
  /// triangles  of the same length; undefined after an error.
  /// errors     kUnsupported: the file was built without BuildOptions::keep, or its attribute layer
  ///            is not open. kBadArgument: an index is not one of the mesh, or `triangles` is
  ///            shorter. kNotFound: the record of an index was skipped, or its triangle is not in
  ///            the region of the file. kReadFailed: a page cannot be read, or not within
  ///            OpenOptions::wait_limit_ms. kDamaged: the file is.
  /// threads    any, one at a time: others wait. Not for real-time threads.
  Result<void> triangles(std::span<const std::uint64_t> indices,
                         std::span<MeshTriangle> triangles) const noexcept;
  /// Returns one triangle, in the same way.
  Result<MeshTriangle> triangle(std::uint64_t index) const noexcept;

  /// Reads what the file says of the model, such as its unit and its coordinate reference system.
  /// Empty if it says nothing. No answer depends on it.
  ///
  /// errors   kReadFailed, kTruncated: the system cannot read it. kDamaged: its hash or its form is
  ///          wrong. kNoMemory.
  /// threads  any, but not real-time threads: allocates, and waits for the disk.
  Result<Metadata> metadata() const;

 private:
  friend class Probe;
  friend class query::ModelState;
  explicit Model(std::unique_ptr<query::ModelState> state) noexcept;
  std::unique_ptr<query::ModelState> state_;
};

}  // namespace planetree
