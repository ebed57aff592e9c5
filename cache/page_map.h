#pragma once

#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cache/frame_pool.h"
#include "cache/protocol_step.h"

namespace planetree::cache {

/// Maps pages to frames. There is one cell per page, which holds frame + 1, or 0 if the page is not
/// resident. Page numbers are dense, so an array suffices and a lookup is one load. A view of
/// memory that PageCache owns; copies see the same cells.
///
/// Any thread inside a section may call find(). Only the writer, the holder of the cache's mutex,
/// may call frame_of(), publish() and withdraw().
template <class Atomics = StdAtomics>
class BasicPageMap {
 public:
  using Cell = typename Atomics::template Atomic<std::uint32_t>;

  explicit BasicPageMap(std::span<Cell> cells) noexcept
      : cells_(cells.data()), count_(cells.size()) {}

  /// R2: returns the frame of `page`, or kNoFrame. Acquires the page's bytes. seq_cst because it
  /// is one side of a store-buffering pair with withdraw(); see reader_slot.h.
  std::uint32_t find(std::uint32_t page) const noexcept {
    assert(page < count_);
    // 0 - 1 wraps to kNoFrame.
    return cells_[page].load(Atomics::order(ProtocolStep::kFind)) - 1;
  }

  /// Cells of all pages, for prefetching. A cell may change at any time.
  const Cell* cells() const noexcept { return cells_; }

  /// Returns the frame of `page`, or kNoFrame. Relaxed, because all stores were made by this
  /// thread or by earlier holders of the mutex.
  std::uint32_t frame_of(std::uint32_t page) const noexcept {
    assert(page < count_);
    return cells_[page].load(std::memory_order_relaxed) - 1;
  }

  /// I7: shows a filled frame to readers. Release, so that a reader that finds the page also sees
  /// the bytes written into its frame.
  void publish(std::uint32_t page, std::uint32_t frame) const noexcept {
    assert(page < count_ && frame != kNoFrame);
    cells_[page].store(frame + 1, Atomics::order(ProtocolStep::kPublish));
  }

  /// E2: hides a page. Readers that found it before may still be reading its frame. seq_cst: the
  /// other side of the pair with find().
  void withdraw(std::uint32_t page) const noexcept {
    assert(page < count_);
    cells_[page].store(0, Atomics::order(ProtocolStep::kWithdraw));
  }

 private:
  Cell* cells_;
  std::size_t count_;  // read by assertions only
};

using PageMap = BasicPageMap<>;

static_assert(PageMap::Cell::is_always_lock_free);
static_assert(kNoFrame == std::uint32_t{0} - 1, "an empty cell must read as kNoFrame");

}  // namespace planetree::cache
