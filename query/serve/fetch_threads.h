#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "cache/page_cache.h"
#include "planetree/contact.h"
#include "planetree/error.h"
#include "planetree/types.h"
#include "query/serve/fetch_requests.h"
#include "query/serve/motion_prefetch.h"
#include "query/serve/read_ahead.h"

namespace planetree::query {

/// Why a fetch thread makes pages resident.
enum class FetchReason : std::uint8_t {
  kMissed,         ///< a query lacked pages
  kMotion,         ///< a probe moves there; its queries do not search for sides
  kMotionOfSides,  ///< a probe moves there; its queries search for sides
};

/// Interface to the probe of a fetch thread. One thread at a time may use it.
class FetchProbe {
 public:
  virtual ~FetchProbe() = default;

  /// Makes the pages resident that a query needs.
  ///
  /// query    model units
  /// options  Wait::kForPages with limited work. Such a query starts from the root, since the
  ///          coherence of this probe does not tell which pages are resident.
  /// ahead    where the probe of the query will be next, at most MotionPrefetch::kPositions. A
  ///          remote model gets the pages there by the same requests. Others leave them out.
  /// stop     once true, the call gives up before the next missing page
  /// return   number of pages that were not resident and are now
  virtual std::uint32_t fetch_pages(const Vec3& query, const QueryOptions& options,
                                    FetchReason reason, std::span<const Vec3> ahead,
                                    const std::atomic<bool>& stop) noexcept = 0;
  /// Makes the pages resident that a search for triangles needs.
  ///
  /// radius, count  the nearest `count` triangles within `radius`, model units
  /// options, stop  as above
  virtual void fetch_triangles(const Vec3& query, double radius, std::uint64_t count,
                               const QueryOptions& options,
                               const std::atomic<bool>& stop) noexcept = 0;
  /// Makes the pages resident that a search along a way needs.
  ///
  /// way            of a moving ball, model units
  /// count          number of triangles that the search may meet
  /// options, stop  as above
  virtual void fetch_way(const Sweep& way, std::uint64_t count, const QueryOptions& options,
                         const std::atomic<bool>& stop) noexcept = 0;
  /// Makes a page resident. Returns whether it was not and is now.
  ///
  /// stop  as above
  virtual bool fetch_page(std::uint32_t page, const std::atomic<bool>& stop) noexcept = 0;
  /// Reads one page that a blocking query waits for. Returns false if there is none.
  virtual bool read_awaited_page() noexcept = 0;
};

/// The work of one fetch thread. It serves fetch requests by running the query again with a probe
/// of its own that waits for pages. It prefetches for moving probes in the same way. It also reads
/// the pages that blocking queries wait for, and all other pages if it is told to. One thread at a
/// time may use it.
class FetchWorker {
 public:
  using Seconds = MotionPrefetch::Seconds;
  using Clock = Seconds (*)();

  /// Memory for each probe that it serves.
  static constexpr std::uint64_t kProbeBytes = 192;

  /// requests     fetch requests of all probes, indexed by reader; must outlive this
  /// first, step  serves the probes with reader index first, first + step, ...
  /// clock        measures the time of fetches, which decides how far ahead to prefetch
  /// stop         once true, work() ends early; must outlive this
  /// read_ahead   pages to read while there is nothing else to do; must outlive this. Null: none
  FetchWorker(std::span<FetchRequests> requests, std::unique_ptr<FetchProbe> probe,
              std::size_t first, std::size_t step, Clock clock, const std::atomic<bool>& stop,
              ReadAhead* read_ahead = nullptr);

  enum class Action : std::uint8_t {
    kNone,
    kServedRequest,
    kPrefetchedPosition,
    kReadAwaitedPage,
    kReadAhead
  };
  /// Takes one action and returns which. Pages that blocking queries wait for and fetch requests
  /// come before prefetching. If there are both, they alternate. Reading ahead comes last.
  Action work() noexcept;
  /// The steps of work(), for a thread that has several workers: reads a page that is waited for or
  /// serves a request; prefetches; reads ahead. Each returns kNone if there is nothing to do.
  Action serve() noexcept;
  Action prefetch() noexcept;
  Action read_ahead() noexcept;

  /// Number of pages read for moving probes, and read ahead, so far. Any thread may call these.
  std::uint64_t pages_prefetched() const noexcept {
    return pages_prefetched_.load(std::memory_order_relaxed);
  }
  std::uint64_t pages_read_ahead() const noexcept {
    return pages_read_ahead_.load(std::memory_order_relaxed);
  }

 private:
  struct Progress {
    // Sequence numbers of the last values loaded, see SeqLock.
    std::uint64_t seen_request = 0, seen_motion = 0;
    MotionPrefetch motion;
  };
  static_assert(sizeof(Progress) <= kProbeBytes);

  bool serve_any_probe(bool (FetchWorker::*step)(std::size_t) noexcept) noexcept;
  bool serve_request(std::size_t index) noexcept;
  void take_motion(std::size_t index) noexcept;
  bool prefetch_position(std::size_t index) noexcept;
  bool read_next_page() noexcept;
  void note_fetch_time(Seconds taken) noexcept;

  const std::span<FetchRequests> requests_;
  std::unique_ptr<FetchProbe> probe_;
  const std::size_t first_, step_;
  const Clock clock_;
  const std::atomic<bool>& stop_;
  ReadAhead* const read_ahead_;     // null: none
  std::vector<Progress> progress_;  // indexed by reader
  std::size_t next_index_ = 0;      // probe served next; they take turns
  bool awaited_page_was_last_ = false;
  Seconds slowest_fetch_{0};  // decaying maximum, see note_fetch_time()
  std::atomic<std::uint64_t> pages_prefetched_{0};
  std::atomic<std::uint64_t> pages_read_ahead_{0};
};

/// The fetch threads of a cache, with one FetchWorker each for every model. A blocking query wakes
/// them. A real-time query cannot, because that takes a system call. So the threads poll for fetch
/// requests, more often if they had something to do within the last second.
class FetchThreads {
 public:
  /// Memory of a thread besides its probe: the used part of its stack.
  static constexpr std::uint64_t kThreadBytes = 65536;

  /// Starts threads, 1 or more, which have nothing to do.
  ///
  /// cache   must outlive this
  /// errors  kNoMemory
  static Result<std::unique_ptr<FetchThreads>> start(cache::PageCache& cache, std::size_t count);
  /// Stops the threads. Waits for the pages that they are reading.
  ~FetchThreads();

  std::size_t count() const noexcept { return lanes_.size(); }
  /// Lets the threads serve the probes of a model.
  ///
  /// requests    fetch requests of all probes, indexed by reader; must outlive this, or be removed
  /// probes      one for each thread
  /// read_ahead  pages to read while there is nothing else to do; must outlive this. Null: none
  /// errors      kNoMemory
  /// threads     one at a time may call this and remove()
  Result<void> add(std::span<FetchRequests> requests,
                   std::vector<std::unique_ptr<FetchProbe>> probes, ReadAhead* read_ahead);
  /// Ends what add() of these requests began. Waits for the pages that the threads are reading.
  void remove(std::span<const FetchRequests> requests) noexcept;

  /// Time between two looks for work, where the last action of a thread was so long ago.
  static std::chrono::microseconds pause_after(std::chrono::nanoseconds since_action) noexcept;

  /// Counters since start(). Any thread may call these; they do not wait.
  std::uint64_t fetch_requests_served() const noexcept {
    return requests_served_.load(std::memory_order_relaxed);
  }
  std::uint64_t pages_prefetched() const noexcept {
    return pages_prefetched_.load(std::memory_order_relaxed);
  }
  std::uint64_t pages_read_ahead() const noexcept {
    return pages_read_ahead_.load(std::memory_order_relaxed);
  }

 private:
  // What one thread serves. The thread holds the mutex while it works.
  struct Lane {
    struct Served {
      const FetchRequests* requests;  // of the first probe
      std::unique_ptr<FetchWorker> worker;
    };
    mutable std::mutex mutex;
    std::vector<Served> served;
    std::size_t first = 0;  // the models take turns to be the first one
    std::thread thread;
  };

  explicit FetchThreads(cache::PageCache& cache) : cache_(cache) {}
  void run(Lane& lane) noexcept;
  FetchWorker::Action work(Lane& lane) noexcept;

  cache::PageCache& cache_;
  std::vector<std::unique_ptr<Lane>> lanes_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::uint64_t> requests_served_{0};
  std::atomic<std::uint64_t> pages_prefetched_{0};
  std::atomic<std::uint64_t> pages_read_ahead_{0};
};

}  // namespace planetree::query
