#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cache/spsc_ring.h"
#include "planetree/trace.h"
#include "planetree/types.h"
#include "query/serve/trace_clock.h"
#include "query/serve/trace_word.h"

namespace planetree::query {

/// The trace of the probes with one reader index. The words of a query are staged: one store
/// publishes them all when the query ends, and until then a missed page can be marked as needed.
///
/// A word that finds no room is dropped and counted, and so are all others until the next query or
/// motion, whose first words are its time and number.
///
/// One thread at a time writes. Real-time queries call the inlined functions; the others are called
/// where a page is missing or read, or once in a tick.
class PageTrace {
 public:
  using Ring = cache::SpscRing<std::uint64_t>;

  /// clock, slots  must outlive this
  void attach(TraceClock& clock, std::span<Ring::Slot> slots) noexcept {
    clock_ = &clock;
    ring_.attach(slots);
  }

  /// Counts a query that looks up no page.
  void count_query() noexcept { ++queries_; }
  void begin_query(PageAccess::Query kind, Wait wait) noexcept {
    prefix_ = TraceWord::prefix(kind, wait == Wait::kForPages, in_batch_, queries_++);
    if (clock_->now() != time_) [[unlikely]]
      begin_time(clock_->now(), queries_ - 1);
  }
  /// Publishes what the query has recorded.
  void end_query() noexcept { ring_.publish(); }
  /// Sets whether the next queries are of a batch.
  void set_in_batch(bool in_batch) noexcept { in_batch_ = in_batch; }

  void hit(std::uint32_t page) noexcept { note(TraceEvent::kHit, page); }
  void missed(std::uint32_t page) noexcept { note(TraceEvent::kMissed, page); }
  /// Notes the squared bound of what the page missed last holds, which a search skips.
  void skipped(float bound) noexcept;
  /// Marks the missed pages with a bound up to `threshold` as needed.
  void need_within(float threshold) noexcept;
  /// Marks the missed pages without a bound as needed.
  void need_others() noexcept;
  /// Notes the width of a degraded answer.
  void degraded(double width) noexcept;
  /// Call it when the query begins to wait for a page.
  void fetched(std::uint32_t page) noexcept;
  void motion(const Vec3& position, const Vec3& velocity) noexcept;

  /// Call it after a page has been read and before queries find it, or after it is evicted; under
  /// the cache's mutex.
  void installed(std::uint32_t page, bool is_upper) noexcept;
  void evicted(std::uint32_t page) noexcept;
  /// Sets for what kind of query a fetch thread reads pages from now on. Returns the last kind.
  PageAccess::Query set_kind(PageAccess::Query kind) noexcept;

  /// Forgets all words. While no other thread uses it.
  void clear() noexcept {
    ring_.clear();
    time_ = kNoTime;
    is_dropping_ = false;
  }

  /// The ring, for the thread that drains.
  Ring& ring() noexcept { return ring_; }

 private:
  void note(TraceEvent event, std::uint64_t rest) noexcept {
    if (ring_.has_room(1) || find_room()) ring_.stage(TraceWord::of(event, prefix_ | rest));
  }
  // Number of the last query; 0 before the first one, as Model::open has no number.
  std::uint64_t last_number() const noexcept { return queries_ > 0 ? queries_ - 1 : 0; }
  bool find_room() noexcept;
  void begin_time(std::uint64_t time, std::uint64_t number) noexcept;
  void note_in_cache(TraceEvent event, std::uint64_t rest) noexcept;
  template <class IsNeeded>
  void mark_needed(const IsNeeded& is_needed) noexcept;

  static constexpr std::uint64_t kNoTime = ~std::uint64_t{0};

  Ring ring_;
  TraceClock* clock_ = nullptr;
  std::uint64_t queries_ = 0;  // so far, also of earlier probes
  // Of the words of the query that runs.
  std::uint64_t prefix_ = TraceWord::prefix(PageAccess::Query::kOpen, true, false, 0);
  std::uint64_t time_ = kNoTime;  // last time in the ring; kNoTime: none, or words were dropped
  bool in_batch_ = false;
  bool is_dropping_ = false;
};

/// What the thread that drains knows of a trace.
struct TraceCursor {
  TraceWord next;            ///< first word that is not decoded yet
  bool has_next = false;     ///< `next` has been taken from the ring
  std::uint64_t time = 0;    ///< of the words from here on
  std::uint64_t number = 0;  ///< of the last query
};

/// The traces of a model, its clock, and what the thread that drains knows of each page.
struct PageTraces {
  TraceClock clock;
  std::span<PageTrace> of_readers;          ///< indexed by reader
  std::span<TraceCursor> cursors;           ///< of the thread that drains; indexed by reader
  std::span<std::uint8_t> states_of_pages;  ///< of the thread that drains; see TraceDecoder

  /// Whether the traces begin with all that Model::open did. Else they have nothing of it.
  bool has_open = false;

  /// Call it at the end of Model::open, before there are threads. Clears the traces if not all that
  /// it did found room.
  void finish_open() noexcept;
  std::uint64_t dropped() const noexcept;
  /// The trace of a fetcher of the cache. pin(), which is no reader, is called before there are
  /// readers.
  PageTrace& of_fetcher(std::uint32_t fetcher) const noexcept {
    return of_readers[fetcher < of_readers.size() ? fetcher : 0];
  }
};

}  // namespace planetree::query
