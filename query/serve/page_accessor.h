#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "cache/page_cache.h"
#include "cache/reader.h"
#include "octree/traversal/tree_view.h"
#include "planetree/types.h"
#include "query/serve/page_trace.h"

namespace planetree::query {

/// Where pages are, for asking ahead.
inline octree::FrameTable frames_of(const cache::Reader& reader) noexcept {
  return {reader.map().cells(), reader.frames(), reader.stride_bytes()};
}

/// One probe's way to pages during one ask: a section of the cache, begun where a page is
/// first looked for, for that is an exchange with memory, and ended with this object.
///
/// An ask that has waited for a page as long as it may waits for no other.
///
/// It stays where it is made: pages() leads to it.
///
/// wait   kNever: what is not resident cannot be had, and the system is not called.
/// terms  how pages are waited for.
/// stop   of a fetch thread, which reads for others in between: once true, what is not resident
///        cannot be had any more. Else null.
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

  /// Where to note what is looked for; null: nowhere.
  void set_trace(PageTraceWriter* trace) noexcept { trace_ = trace; }

  /// The page's frame, good until the next call, or until the keeper that pages() names is told;
  /// null if it cannot be had.
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

  /// Whether a page was not resident that the ask did not wait for.
  bool missed() const noexcept { return missed_; }

  /// Where page() would find it, or null.
  const std::byte* peek(std::uint32_t number) noexcept {
    begin_section();
    return reader_.peek(number);
  }

  const octree::PageReader& pages() const noexcept { return pages_; }

 private:
  void begin_section() noexcept {
    if (!reader_.inside()) reader_.enter();
  }
  // Before a section ends of which there are pointers.
  void release_frames() noexcept {
    if (release_hook_.on_release) release_hook_.on_release(release_hook_.context);
  }
  void advance_prefetcher() noexcept {
    if (!prefetch_hook_.step(prefetch_hook_.context, pages_)) prefetch_hook_ = {};
  }
  const std::byte* fetch(std::uint32_t number) noexcept;

  // Evicted frames are reused only after sections that may see them end.
  static constexpr std::uint32_t kLookupsPerSection = 256;
  // What a step asks for takes about as long to come.
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
  bool may_wait_;  // until it has waited long enough
  bool missed_ = false;
  std::uint32_t lookups_ = 0;
};

}  // namespace planetree::query
