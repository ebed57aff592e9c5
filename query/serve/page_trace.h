#pragma once

#include <atomic>
#include <cstdint>

#include "cache/spsc_ring.h"
#include "planetree/trace.h"
#include "planetree/types.h"

namespace planetree::query {

/// A PageTouch, less what is known elsewhere.
struct Touch {
  std::uint64_t ask = 0;
  std::uint32_t page = 0;
  PageTouch::Kind kind = PageTouch::Kind::kHit;
};

/// What the probes of one place leave for Model::take_touches.
struct TouchTrace {
  cache::TraceRing<Touch> ring;
  std::uint64_t asks = 0;  ///< the probe's; the next one there goes on
};

/// Says which pages were brought because a probe was moving there, and not looked for since.
/// Relaxed: nothing else follows from it.
using PrefetchMark = std::atomic<std::uint8_t>;

/// One probe's notes of the pages it looks for, where the model keeps a trace.
class TouchLog {
 public:
  /// Both null where there is no trace.
  TouchLog(TouchTrace* trace, PrefetchMark* marks) noexcept : trace_(trace), marks_(marks) {}

  /// At the beginning of an ask; null where there is nothing to note.
  TouchLog* begin_ask(Wait wait) noexcept {
    if (trace_ == nullptr) return nullptr;
    waits_ = wait == Wait::kForPages;
    if (!waits_) ++trace_->asks;
    return this;
  }
  /// Whether what is fetched is for later.
  void set_looks_ahead(bool ahead) noexcept { looks_ahead_ = ahead; }

  void found(std::uint32_t page) noexcept {
    const bool prefetched = marks_[page].load(std::memory_order_relaxed) != 0;
    if (prefetched && !looks_ahead_) marks_[page].store(0, std::memory_order_relaxed);
    if (!waits_) note(page, prefetched ? PageTouch::Kind::kPrefetched : PageTouch::Kind::kHit);
  }
  void missed(std::uint32_t page) noexcept { note(page, PageTouch::Kind::kMissed); }
  void fetched(std::uint32_t page) noexcept {
    marks_[page].store(looks_ahead_ ? 1 : 0, std::memory_order_relaxed);
  }

 private:
  void note(std::uint32_t page, PageTouch::Kind kind) noexcept {
    trace_->ring.give({trace_->asks - 1, page, kind});
  }

  TouchTrace* trace_;
  PrefetchMark* marks_;
  bool waits_ = false;
  bool looks_ahead_ = false;
};

}  // namespace planetree::query
