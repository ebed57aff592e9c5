#pragma once

#include <atomic>
#include <cstdint>

#include "cache/spsc_ring.h"
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

}  // namespace planetree::query
