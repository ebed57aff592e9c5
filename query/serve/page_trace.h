#pragma once

#include <atomic>
#include <cstdint>

#include "cache/spsc_ring.h"
#include "planetree/trace.h"
#include "planetree/types.h"

namespace planetree::query {

/// A PageAccess, less what is known elsewhere.
struct TracedAccess {
  std::uint64_t query = 0;
  std::uint32_t page = 0;
  PageAccess::Kind kind = PageAccess::Kind::kHit;
};

/// What the probes of one place leave for Model::drain_page_trace.
struct PageTrace {
  cache::SpscRing<TracedAccess> ring;
  std::uint64_t queries = 0;  ///< the probe's; the next one there goes on
};

/// Says which pages were brought because a probe was moving there, and not looked for since.
/// Relaxed: nothing else follows from it.
using PrefetchMark = std::atomic<std::uint8_t>;

/// One probe's notes of the pages it looks for, where the model keeps a trace.
class PageTraceWriter {
 public:
  /// Both null where there is no trace.
  PageTraceWriter(PageTrace* trace, PrefetchMark* marks) noexcept : trace_(trace), marks_(marks) {}

  /// At the beginning of an ask; null where there is nothing to note.
  PageTraceWriter* begin_query(Wait wait) noexcept {
    if (trace_ == nullptr) return nullptr;
    is_blocking_ = wait == Wait::kForPages;
    if (!is_blocking_) ++trace_->queries;
    return this;
  }
  /// Whether what is fetched is for later.
  void set_prefetching(bool ahead) noexcept { is_prefetching_ = ahead; }

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

}  // namespace planetree::query
