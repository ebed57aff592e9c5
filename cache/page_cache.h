#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "cache/cache_memory.h"
#include "cache/frame_pool.h"
#include "cache/in_flight_reads.h"
#include "cache/limbo.h"
#include "cache/page_ranges.h"
#include "cache/policy/evictor.h"
#include "cache/prefaulted_memory.h"
#include "cache/protocol.h"
#include "cache/reader.h"
#include "planetree/error.h"

namespace planetree::cache {

/// A page to decode, and the frame to decode it into.
struct FillRequest {
  std::uint32_t page;
  std::uint32_t fetcher;       ///< 0 ... max_readers; simultaneous requests have different fetchers
  bool may_block;              ///< whether to wait as long as the disk takes
  std::span<std::byte> frame;  ///< frame_bytes long; holds arbitrary old bytes
};
/// What a FillPage did.
enum class FillResult : std::uint8_t {
  kFilled,       ///< the frame holds a page of the lower tier
  kFilledUpper,  ///< the frame holds a page of the upper tier: it links to other pages
  kWouldBlock,   ///< the read would block; only if the request forbids to wait
  kLate,         ///< the page cannot be read now; a later fetch may read it
};

/// Fills a frame with the decoded page. Any number of threads call it at once, without the
/// cache's mutex and outside of their sections. It must not throw and must not call the cache.
using FillPage = Result<FillResult> (*)(void* context, const FillRequest& request);

/// Is told of the pages that a cache makes resident or evicts. The calls are made under the cache's
/// mutex, by the thread that reads a page. They must not throw, wait or call the cache.
struct CacheObserver {
  void* context = nullptr;
  /// A page is about to be shown to readers.
  void (*on_install)(void* context, std::uint32_t fetcher, std::uint32_t page,
                     PageTier tier) noexcept = nullptr;
  /// A page has been hidden from readers, for a page that `fetcher` is to read.
  void (*on_evict)(void* context, std::uint32_t fetcher, std::uint32_t page) noexcept = nullptr;
};

/// Counts since create(). While other threads work, the counts may be inconsistent with each
/// other by a few events.
struct CacheStats {
  std::uint64_t hits;         ///< calls of Reader::find() that returned a frame
  std::uint64_t misses;       ///< calls of Reader::find() that returned nullptr
  std::uint64_t fills;        ///< pages made resident; fills - evictions pages are resident
  std::uint64_t evictions;    ///< pages evicted
  std::uint64_t quarantined;  ///< pages found unreadable
  std::uint64_t given_up;     ///< fetches that ended at their wait limit
  std::uint32_t frame_count;
  std::uint64_t arena_bytes;     ///< memory of the frames
  std::uint64_t table_bytes;     ///< memory of the CacheTables
  std::uint64_t reserved_bytes;  ///< CacheLimits::reserved_bytes
  std::uint64_t budget_bytes;  ///< CacheLimits::budget_bytes; covers the three above and the object
  std::uint64_t locked_bytes;  ///< locked part of arena and tables
};

/// Decoded pages in a fixed number of frames.
///
/// There are many readers and one writer. Readers find pages without waiting; protocol.h
/// describes the protocol. The writer is the thread that holds the mutex. The mutex guards
/// decisions only: pages are read and decoded without it. Each page is read by one thread, either
/// the one that misses it or a helper (see FetchTerms).
///
/// The cycle of a frame:
///
///     free --fill--> resident --evict--> limbo --sections over--> filled again
///       ^____________________________(fill failed)________________|
///
/// All memory is claimed in create(); nothing allocates after it.
///
/// The pages of a shared cache (CacheLimits::is_shared) are those of files that come and go. Each
/// file has a range of page numbers. It lends the memory of frames for the tables of its pages, and
/// for what else its caller needs.
class PageCache {
 public:
  /// Creates a cache with as many frames as the budget allows, at most one per page.
  ///
  /// context  passed to `fill`; must outlive the cache.
  /// errors   kBadArgument: limits out of range; kNoMemory: the budget is below the minimum, which
  ///          the text names, or the system has no memory.
  static Result<std::unique_ptr<PageCache>> create(const CacheLimits& limits, FillPage fill,
                                                   void* context) noexcept;

  /// All readers must have been destroyed.
  ~PageCache();
  PageCache(const PageCache&) = delete;
  PageCache& operator=(const PageCache&) = delete;

  /// Makes a page resident for good. Must not be called inside a section.
  ///
  /// errors   those of `fill`; kDamaged: the page was found unreadable earlier; kNoMemory: too few
  ///          frames would be left for fetches.
  /// threads  one at a time.
  Result<void> pin(std::uint32_t page) noexcept;

  /// Creates a reader. Simultaneous readers have different Reader::index() below max_readers.
  ///
  /// errors   kBadArgument: there are max_readers readers already.
  /// threads  any.
  Result<Reader> claim_reader() noexcept;

  /// Adds the pages of a file to a shared cache, and returns the number of the first one.
  ///
  /// page_count  above 0.
  /// bytes       memory of the caller for this file, which frames give up.
  /// errors      kNoMemory: too few frames would be left for fetches, with a pinned page for each
  ///             file; the text says how much is lacking. There are too many pages.
  /// threads     any, one at a time with remove_file() and pin().
  Result<std::uint32_t> add_file(std::uint32_t page_count, std::uint64_t bytes) noexcept;
  /// Removes the pages of a file, pinned ones too, and backs the frames again that add_file() took.
  /// No reader may be looking one of these pages up, hold a frame of one, or wait for one.
  ///
  /// first, bytes  returned by and given to add_file(). The caller has freed the memory.
  void remove_file(std::uint32_t first, std::uint64_t bytes) noexcept;
  /// Returns a reader of the pages of one file of a shared cache, whose numbers then go from 0. It
  /// uses the slot of the reader with this index: only one thread at a time may use either, and
  /// neither while the other is inside a section. The destructor does not release the slot.
  Reader window(std::uint32_t reader_index, std::uint32_t first_page) noexcept;

  /// Locks arena and tables in memory, so that the system does not page them out. Returns false
  /// if the system refuses for either. Call it before there are readers.
  bool lock_memory() noexcept;

  /// Sets whom to tell of installed and evicted pages. Call it before there are readers.
  void set_observer(const CacheObserver& observer) noexcept { observer_ = observer; }

  /// For helpers: returns when a fetcher waits for a page that no fetcher reads, when `stop` is
  /// true, or when the given time has passed. After setting `stop`, call wake_helpers().
  void wait_for_wanted_page(std::chrono::microseconds max_wait,
                            const std::atomic<bool>& stop) noexcept;
  void wake_helpers() noexcept;

  std::uint32_t frame_count() const noexcept {
    return frames_.frame_count() - discarded_count_.load(std::memory_order_relaxed);
  }
  /// Whether each page that may be fetched has a frame, so that none is evicted. False for a shared
  /// cache.
  bool holds_all_pages() const noexcept {
    return !limits_.is_shared && frame_count() >= limits_.used_pages();
  }

  /// Returns the counts and sizes.
  /// threads  any; takes no lock.
  CacheStats stats() const noexcept;

 private:
  friend class Reader;
  using Lock = std::unique_lock<std::mutex>;

  /// Result of an attempt to make a page resident.
  enum class Outcome { kResident, kUnreadable, kWouldBlock, kRetry, kGivenUp };

  PageCache(const CacheLimits& limits, FillPage fill, void* context, PrefaultedMemory memory,
            std::optional<PrefaultedMemory> page_memory, FramePool frames) noexcept;

  // These are defined in page_fetch.cpp, which explains why they end. A fetcher is identified by a
  // reader's index or by pin_fetcher(); it has one entry in limbo_ and one in in_flight_reads_.
  // Functions with a Lock parameter hold the mutex when they are called and when they return, but
  // may release it in between.
  FetchResult fetch(ReaderSlot& slot, std::uint32_t page, const FetchTerms& terms) noexcept;
  bool help(std::uint32_t fetcher) noexcept;
  Outcome make_resident(Lock& lock, std::uint32_t fetcher, std::uint32_t page,
                        const FetchTerms& terms, Error* why) noexcept;
  Outcome read_page(Lock& lock, std::uint32_t fetcher, std::uint32_t page, std::uint32_t frame,
                    bool may_block, Error* why) noexcept;
  Outcome wait_for_page(Lock& lock, std::uint32_t fetcher, std::uint32_t page,
                        const FetchTerms& terms) noexcept;
  std::uint32_t take_frame(Lock& lock, std::uint32_t fetcher, std::uint32_t attempt) noexcept;
  void wake(std::uint32_t fetcher) noexcept { wakers_[fetcher % kWakers].notify_all(); }

  // The caller of the functions below holds the mutex.
  std::uint32_t try_to_take_frame(std::uint32_t fetcher) noexcept;
  bool evict_into_limbo(std::uint32_t fetcher) noexcept;
  Result<void> pin_resident(std::uint32_t page) noexcept;
  std::uint32_t pin_fetcher() const noexcept { return limits_.max_readers; }
  // These are defined in shared_cache.cpp.
  Result<void> lend(Lock& lock, std::uint64_t bytes) noexcept;
  void discard_frames(Lock& lock, std::uint32_t count) noexcept;
  void reclaim_frames(std::uint32_t count) noexcept;
  Result<void> back_tables(std::uint32_t page_count) noexcept;
  void forget(std::uint32_t page) noexcept;

  bool quarantined(std::uint32_t page) const noexcept;
  void quarantine(std::uint32_t page) noexcept;

  // Written under the mutex and read by stats() at any time. Relaxed order suffices.
  struct Counts {
    std::atomic<std::uint64_t> fills{0};
    std::atomic<std::uint64_t> evictions{0};
    std::atomic<std::uint64_t> quarantined{0};
    std::atomic<std::uint64_t> given_up{0};
  };
  static void add_one(std::atomic<std::uint64_t>& count) noexcept {
    count.fetch_add(1, std::memory_order_relaxed);
  }

  // Waiting fetchers share these condition variables. A fetcher woken for another waits again.
  static constexpr std::uint32_t kWakers = 16;

  const CacheLimits limits_;
  const FillPage fill_;
  void* const context_;
  PrefaultedMemory table_memory_;
  const std::optional<PrefaultedMemory> page_memory_;  // of a shared cache: tables of its pages
  FramePool frames_;
  const CacheTables tables_;
  const PageMap map_;

  std::mutex mutex_;
  std::array<std::condition_variable, kWakers> wakers_;
  std::condition_variable helpers_waker_;
  Evictor evictor_;
  Limbo limbo_;
  InFlightReads in_flight_reads_;
  std::uint32_t free_count_;
  std::uint32_t pinned_count_ = 0;
  // Of a shared cache. Frames whose memory is lent stand at the end of tables_.free_frames.
  PageRanges files_;
  std::uint32_t file_count_ = 0;
  std::uint32_t backed_pages_ = 0;  // pages whose tables are backed by memory
  std::uint64_t lent_bytes_ = 0;
  std::atomic<std::uint32_t> discarded_count_{0};  // frames without memory
  std::uint64_t locked_bytes_ = 0;
  CacheObserver observer_;  // without functions: none
  Counts counts_;
};

}  // namespace planetree::cache
