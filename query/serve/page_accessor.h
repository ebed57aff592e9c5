#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cache/page_cache.h"
#include "cache/reader.h"
#include "octree/traversal/tree_view.h"
#include "planetree/types.h"
#include "query/serve/page_trace.h"

namespace planetree::query {

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
        may_wait_(wait == Wait::kForPages) {}
  ~PageAccessor() {
    if (!reader_.inside()) return;
    reader_.leave();
    if (trace_) trace_->end_query();
  }
  PageAccessor(const PageAccessor&) = delete;
  PageAccessor& operator=(const PageAccessor&) = delete;

  /// Sets where page lookups are recorded; null: nowhere.
  void set_trace(PageTrace* trace) noexcept { trace_ = trace; }

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
      return trace_ ? note_hit(number, frame) : frame;
    }
    if (may_wait_ && !(stop_ && stop_->load(std::memory_order_relaxed))) return fetch(number);
    if (trace_) trace_->missed(number);
    note_missed(number);
    return nullptr;
  }

  /// Number of pages that were missing and were fetched.
  std::uint32_t fetched() const noexcept { return fetched_; }

  /// Whether the query went on without a page: it may not wait, or its wait was given up.
  bool missed() const noexcept { return missed_; }

  /// Keeps the numbers of the first pages that the query goes on without, each once, as far
  /// as there is room.
  void keep_missed(std::span<std::uint32_t> room) noexcept { missed_room_ = room; }
  std::size_t kept_missed() const noexcept { return kept_missed_; }

  /// Returns the page's frame if it is resident, else null. Reads nothing and records nothing.
  const std::byte* peek(std::uint32_t number) noexcept {
    begin_section();
    return reader_.peek(number);
  }

  /// Returns the same access for traversals.
  const octree::PageReader& pages() const noexcept { return pages_; }

 private:
  static const octree::MissHook kMissHook;  // reports to the trace

  void begin_section() noexcept {
    if (!reader_.inside()) reader_.enter();
  }
  void note_missed(std::uint32_t number) noexcept {
    if (kept_missed_ < missed_room_.size()) keep_missed(number);
    missed_ = true;
  }
  void keep_missed(std::uint32_t number) noexcept {
    const auto known = missed_room_.first(kept_missed_);
    if (std::find(known.begin(), known.end(), number) == known.end())
      missed_room_[kept_missed_++] = number;
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
    release_frames();
    if (stop_) help();
    if (trace_) trace_->fetched(number);
    const cache::FetchResult fetched = reader_.fetch(number, terms_);
    if (fetched.given_up) {
      note_missed(number);
      may_wait_ = false;
    }
    if (fetched.frame) ++fetched_;
    return fetched.frame;
  }

  // Not inlined, so that page() saves few registers where nothing is traced.
  [[gnu::noinline]] const std::byte* note_hit(std::uint32_t number,
                                              const std::byte* frame) noexcept {
    trace_->hit(number);
    return frame;
  }
  void help() noexcept {
    reader_.leave();
    const PageAccess::Query kind =
        trace_ ? trace_->set_kind(PageAccess::Query::kFetch) : PageAccess::Query::kFetch;
    reader_.help();
    if (trace_) trace_->set_kind(kind);
    reader_.enter();
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
            &release_hook_,
            &kMissHook};
  }

  const octree::PageReader pages_;
  cache::Reader& reader_;
  const cache::FetchTerms terms_;
  const std::atomic<bool>* const stop_;
  octree::FrameReleaseHook release_hook_;
  octree::PrefetchHook prefetch_hook_;
  PageTrace* trace_ = nullptr;
  bool may_wait_;  // false for good after a wait was given up
  bool missed_ = false;
  std::span<std::uint32_t> missed_room_;
  std::size_t kept_missed_ = 0;
  std::uint32_t lookups_ = 0;
  std::uint32_t fetched_ = 0;
};

inline const octree::MissHook PageAccessor::kMissHook = {
    [](void* context, float bound) noexcept {
      if (PageTrace* trace = static_cast<PageAccessor*>(context)->trace_) trace->skipped(bound);
    },
    [](void* context, float threshold) noexcept {
      if (PageTrace* trace = static_cast<PageAccessor*>(context)->trace_)
        trace->need_within(threshold);
    },
    [](void* context) noexcept {
      if (PageTrace* trace = static_cast<PageAccessor*>(context)->trace_) trace->need_others();
    }};

}  // namespace planetree::query
