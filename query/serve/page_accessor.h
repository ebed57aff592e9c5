#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "cache/page_cache.h"
#include "cache/reader.h"
#include "cache/spsc_ring.h"
#include "octree/traversal/tree_view.h"
#include "planetree/trace.h"
#include "planetree/types.h"

namespace planetree::query {

/// The members of a PageAccess that are not known elsewhere.
struct TracedAccess {
  std::uint64_t query = 0;
  std::uint32_t page = 0;
  PageAccess::Kind kind = PageAccess::Kind::kHit;
};

/// The page accesses of the probes with one reader index, for Model::drain_page_trace.
struct PageTrace {
  cache::SpscRing<TracedAccess> ring;
  std::uint64_t queries = 0;  ///< real-time queries so far, also of earlier probes
};

/// One mark per page. Not 0: the page was fetched because a probe moved towards it, and no query
/// has looked it up since. Accessed with relaxed order, since no other data depends on it.
using PrefetchMark = std::atomic<std::uint8_t>;

/// Records one probe's page lookups if the model keeps a trace. One thread at a time may use it.
class PageTraceWriter {
 public:
  /// marks  indexed by page. Both are null if there is no trace.
  PageTraceWriter(PageTrace* trace, PrefetchMark* marks) noexcept : trace_(trace), marks_(marks) {}

  /// Call it at the beginning of a query. Returns this, or null if there is no trace.
  PageTraceWriter* begin_query(Wait wait) noexcept {
    if (trace_ == nullptr) return nullptr;
    is_blocking_ = wait == Wait::kForPages;
    if (!is_blocking_) ++trace_->queries;
    return this;
  }
  /// Sets whether the pages fetched from now on are for a moving probe.
  void set_prefetching(bool ahead) noexcept { is_prefetching_ = ahead; }

  /// Record a lookup: the page was resident, was not available, or is being fetched.
  void found(std::uint32_t page) noexcept {
    const bool prefetched = marks_[page].load(std::memory_order_relaxed) != 0;
    if (prefetched && !is_prefetching_) marks_[page].store(0, std::memory_order_relaxed);
    if (!is_blocking_)
      note(page, prefetched ? PageAccess::Kind::kPrefetched : PageAccess::Kind::kHit);
  }
  void missed(std::uint32_t page) noexcept { note(page, PageAccess::Kind::kMissed); }
  void fetched(std::uint32_t page) noexcept {
    marks_[page].store(is_prefetching_ ? 1 : 0, std::memory_order_relaxed);
  }

 private:
  void note(std::uint32_t page, PageAccess::Kind kind) noexcept {
    trace_->ring.push({trace_->queries - 1, page, kind});
  }

  PageTrace* trace_;
  PrefetchMark* marks_;
  bool is_blocking_ = false;
  bool is_prefetching_ = false;
};

/// Returns the table of frames, for prefetching.
inline octree::FrameTable frames_of(const cache::Reader& reader) noexcept {
  return {reader.map().cells(), reader.frames(), reader.stride_bytes()};
}

/// One query's access to pages. It holds a section of the cache. The section begins at the first
/// page lookup, since beginning one takes an atomic exchange, and ends with this object at the
/// latest.
///
/// After a wait for a page has reached its limit, the query waits for no other page.
///
/// The object cannot be moved, because pages() points to it.
///
/// wait   kNever: pages that are not resident are not available, and no system call is made
/// terms  how to wait for pages
/// stop   only for fetch threads, which read pages for blocking queries in between; once true,
/// pages
///        that are not resident are no longer available. Else null.
class PageAccessor {
 public:
  PageAccessor(cache::Reader& reader, Wait wait, const cache::FetchTerms& terms = {},
               const std::atomic<bool>* stop = nullptr) noexcept
      : pages_(pages_of(reader)),
        reader_(reader),
        terms_(terms),
        stop_(stop),
        wait_(wait),
        may_wait_(wait == Wait::kForPages) {}
  ~PageAccessor() {
    if (reader_.inside()) reader_.leave();
  }
  PageAccessor(const PageAccessor&) = delete;
  PageAccessor& operator=(const PageAccessor&) = delete;

  /// Sets where page lookups are recorded; null: nowhere.
  void set_trace(PageTraceWriter* trace) noexcept { trace_ = trace; }

  /// Returns the page's frame, or null if it is not available. The pointer is valid until the next
  /// call or, if the release hook of pages() is set, until the hook is called.
  const std::byte* page(std::uint32_t number) noexcept {
    if (++lookups_ % kLookupsPerSection == 0) {
      release_frames();
      reader_.leave();
    }
    begin_section();
    if (prefetch_hook_.context && lookups_ % kLookupsPerStep == 0) advance_prefetcher();
    if (const std::byte* frame = reader_.find(number)) {
      if (trace_) trace_->found(number);
      return frame;
    }
    if (may_wait_ && !(stop_ && stop_->load(std::memory_order_relaxed))) return fetch(number);
    if (trace_ && wait_ == Wait::kNever) trace_->missed(number);
    missed_ = true;
    return nullptr;
  }

  /// Whether the query went on without a page: it may not wait, or its wait was given up.
  bool missed() const noexcept { return missed_; }

  /// Returns the page's frame if it is resident, else null. Reads nothing and records nothing.
  const std::byte* peek(std::uint32_t number) noexcept {
    begin_section();
    return reader_.peek(number);
  }

  /// Returns the same access for traversals.
  const octree::PageReader& pages() const noexcept { return pages_; }

 private:
  void begin_section() noexcept {
    if (!reader_.inside()) reader_.enter();
  }
  // Call it before a section ends: a traversal may hold pointers to frames.
  void release_frames() noexcept {
    if (release_hook_.on_release) release_hook_.on_release(release_hook_.context);
  }
  void advance_prefetcher() noexcept {
    if (!prefetch_hook_.step(prefetch_hook_.context, pages_)) prefetch_hook_ = {};
  }
  // A fetch thread (stop_ is set) first reads one page that a blocking query waits for, so that
  // neither waits for all pages of the other.
  // Not inlined: few lookups fetch.
  [[gnu::noinline]] const std::byte* fetch(std::uint32_t number) noexcept {
    if (trace_) trace_->fetched(number);
    release_frames();
    if (stop_) {
      reader_.leave();
      reader_.help();
      reader_.enter();
    }
    const cache::FetchResult fetched = reader_.fetch(number, terms_);
    if (fetched.given_up) {
      missed_ = true;
      may_wait_ = false;
    }
    return fetched.frame;
  }

  // The section is renewed after so many lookups, since evicted frames are reused only after the
  // sections that may see them have ended.
  static constexpr std::uint32_t kLookupsPerSection = 256;
  // A step's cache line takes about as long to arrive as so many lookups take.
  static constexpr std::uint32_t kLookupsPerStep = 2;

  octree::PageReader pages_of(const cache::Reader& reader) noexcept {
    return {this,
            [](void* context, std::uint32_t number) noexcept {
              return static_cast<PageAccessor*>(context)->page(number);
            },
            [](void* context, std::uint32_t number) noexcept {
              return static_cast<PageAccessor*>(context)->peek(number);
            },
            frames_of(reader),
            &prefetch_hook_,
            &release_hook_};
  }

  const octree::PageReader pages_;
  cache::Reader& reader_;
  const cache::FetchTerms terms_;
  const std::atomic<bool>* const stop_;
  octree::FrameReleaseHook release_hook_;
  octree::PrefetchHook prefetch_hook_;
  PageTraceWriter* trace_ = nullptr;
  const Wait wait_;
  bool may_wait_;  // false for good after a wait was given up
  bool missed_ = false;
  std::uint32_t lookups_ = 0;
};

}  // namespace planetree::query
