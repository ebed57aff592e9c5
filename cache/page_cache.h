#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>

#include "cache/cache_limits.h"
#include "cache/cache_tables.h"
#include "cache/eviction_policy.h"
#include "cache/frame_pool.h"
#include "cache/in_flight_reads.h"
#include "cache/limbo.h"
#include "cache/page_map.h"
#include "cache/prefaulted_memory.h"
#include "cache/reader.h"
#include "planetree/error.h"

namespace planetree::cache {

/// What is to be filled, and by whom.
struct FillRequest {
  std::uint32_t page;
  std::uint32_t fetcher;       ///< 0 ... max_readers; no two at the same time are of one owner
  bool may_wait;               ///< for a disk, longer than a moment
  std::span<std::byte> frame;  ///< frame_bytes long, old bytes in it
};
enum class Filled : std::uint8_t {
  kFilled,
  kFilledUpper,  ///< with a page through which others are reached
  kWouldWait,
};

/// Fills a frame with the decoded page. Called by any number of threads at once, without the
/// cache's mutex and outside the thread's section. Must not throw and must not call the cache.
using FillPage = Result<Filled> (*)(void* context, const FillRequest& request);

/// Counts since create(). Taken while others work, they need not agree with
/// each other to the last one.
struct CacheStats {
  std::uint64_t hits;         ///< finds that returned a frame
  std::uint64_t misses;       ///< finds that returned nullptr
  std::uint64_t fills;        ///< pages made resident; fills - evictions are resident
  std::uint64_t evictions;    ///< pages removed to make room
  std::uint64_t quarantined;  ///< pages found unreadable
  std::uint64_t given_up;     ///< fetches that ended because they had waited long enough
  std::uint32_t frame_count;
  std::uint64_t arena_bytes;     ///< of the frames
  std::uint64_t table_bytes;     ///< of the page map, reader slots and the like
  std::uint64_t reserved_bytes;  ///< as asked
  std::uint64_t budget_bytes;    ///< as asked; the three above and the object fit in it
  std::uint64_t locked_bytes;    ///< of arena and tables
};

/// Decoded pages in a fixed number of frames.
///
/// Many readers, one writer. Readers find pages without waiting; see
/// reader_slot.h for the protocol. The writer is whoever holds the mutex, which
/// guards decisions only: pages are read and decoded without it, by the thread
/// that misses or by a helper (see FetchTerms), each page by one thread.
///
/// A frame goes round:
///
///     free --fill--> resident --evict--> limbo --sections over--> filled again
///       ^____________________________(fill failed)________________|
///
/// All memory is claimed in create(); nothing allocates after it.
class PageCache {
 public:
  /// Takes as many frames as the budget allows, at most one per page.
  /// `context` is handed to `fill` and must outlive the cache. Fails with
  /// kBadArgument for limits out of range; with kNoMemory if the budget is
  /// below the minimum, which the text names, or if the system has no memory.
  static Result<std::unique_ptr<PageCache>> create(const CacheLimits& limits, FillPage fill,
                                                   void* context) noexcept;

  /// All readers must be gone.
  ~PageCache();
  PageCache(const PageCache&) = delete;
  PageCache& operator=(const PageCache&) = delete;

  /// Makes a page resident for good. One thread at a time, not inside a section.
  /// Fails with the error of `fill`; with kDamaged if the page was found
  /// unreadable earlier; with kNoMemory if fetches would be left with too few
  /// frames.
  Result<void> pin(std::uint32_t page) noexcept;

  /// Any thread. Fails with kBadArgument if max_readers are there already. Readers that are
  /// there at one time have different Reader::place()s below max_readers.
  Result<Reader> claim_reader() noexcept;

  /// Keeps the system from paging arena and tables out; false where that is not allowed.
  /// Before there are readers.
  bool lock_memory() noexcept;

  /// For helpers: returns once there is a page to read for others, `stop` is true, or so much
  /// time is over. Who sets `stop` then calls wake_helpers().
  void wait_for_read(std::chrono::microseconds most, const std::atomic<bool>& stop) noexcept;
  void wake_helpers() noexcept;

  /// Any thread; waits for nobody.
  CacheStats stats() const noexcept;

 private:
  friend class Reader;
  using Lock = std::unique_lock<std::mutex>;

  /// What became of a page that was to be resident.
  enum class Outcome { kResident, kUnreadable, kWouldWait, kRetry, kGivenUp };

  PageCache(const CacheLimits& limits, FillPage fill, void* context, PrefaultedMemory memory,
            FramePool frames) noexcept;

  // page_fetch.cpp has these, and says why they end. An owner is a place in limbo and an errand:
  // a reader's index, or pin_fetcher(). What takes the lock has it when it returns, but not always
  // meanwhile.
  Fetched fetch(ReaderSlot& slot, std::uint32_t page, const FetchTerms& terms) noexcept;
  bool help(std::uint32_t fetcher) noexcept;
  Outcome make_resident(Lock& lock, std::uint32_t fetcher, std::uint32_t page,
                        const FetchTerms& terms, Error* why) noexcept;
  Outcome read_page(Lock& lock, std::uint32_t fetcher, std::uint32_t page, std::uint32_t frame,
                    bool may_wait, Error* why) noexcept;
  Outcome wait_for_page(Lock& lock, std::uint32_t fetcher, std::uint32_t page,
                        const FetchTerms& terms) noexcept;
  std::uint32_t take_frame(Lock& lock, std::uint32_t fetcher, std::uint32_t attempt) noexcept;
  void wake(std::uint32_t fetcher) noexcept { wakers_[fetcher % kWakers].notify_all(); }

  // All below need the mutex.
  std::uint32_t try_to_take_frame(std::uint32_t fetcher) noexcept;
  bool evict_into_limbo(std::uint32_t fetcher) noexcept;
  Result<void> pin_resident(std::uint32_t page) noexcept;
  std::uint32_t pin_fetcher() const noexcept { return limits_.max_readers; }
  bool quarantined(std::uint32_t page) const noexcept;
  void quarantine(std::uint32_t page) noexcept;

  // Written under the mutex, read by stats() at any time: relaxed suffices.
  struct Counts {
    std::atomic<std::uint64_t> fills{0};
    std::atomic<std::uint64_t> evictions{0};
    std::atomic<std::uint64_t> quarantined{0};
    std::atomic<std::uint64_t> given_up{0};
  };
  static void add_one(std::atomic<std::uint64_t>& count) noexcept {
    count.fetch_add(1, std::memory_order_relaxed);
  }

  // Fetchers that wait share these: whoever is woken for another goes on waiting.
  static constexpr std::uint32_t kWakers = 16;

  const CacheLimits limits_;
  const FillPage fill_;
  void* const context_;
  PrefaultedMemory table_memory_;
  FramePool frames_;
  const CacheTables tables_;
  const PageMap map_;

  std::mutex mutex_;
  std::array<std::condition_variable, kWakers> wakers_;
  std::condition_variable helpers_waker_;
  EvictionPolicy policy_;
  Limbo limbo_;
  InFlightReads in_flight_reads_;
  std::uint32_t free_count_;
  std::uint32_t pinned_count_ = 0;
  std::uint64_t locked_bytes_ = 0;
  Counts counts_;
};

}  // namespace planetree::cache
