#pragma once

#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cache/policy/frame_states.h"

namespace planetree::cache {

/// Steps of the protocol between readers and the writer. Apart from the mutex these are the only
/// places where the memory order matters. BasicReaderSlot and BasicPageMap justify the order of
/// each step. R, E and I number the steps of reading, evicting and installing a page.
enum class ProtocolStep : std::uint8_t {
  kClaim,          ///< a new reader continues the sequence and counts of the slot's last reader
  kRelease,        ///< a reader hands the slot on; the other side of kClaim
  kEnter,          ///< R1: a reader begins a section
  kFind,           ///< R2: the reader looks up a page
  kLeave,          ///< R5: the reader ends the section
  kWithdraw,       ///< E2: the writer hides a page
  kNoteSections,   ///< E3: the writer notes which sections are open
  kSeeSectionEnd,  ///< E5: the writer finds that a noted section has ended
  kPublish,        ///< I7: the writer shows a filled frame
};

/// Memory order of each step.
constexpr std::memory_order order_of(ProtocolStep step) noexcept {
  switch (step) {
    case ProtocolStep::kEnter:
    case ProtocolStep::kFind:
    case ProtocolStep::kWithdraw:
    case ProtocolStep::kNoteSections:
      return std::memory_order_seq_cst;
    case ProtocolStep::kClaim:
    case ProtocolStep::kSeeSectionEnd:
      return std::memory_order_acquire;
    case ProtocolStep::kRelease:
    case ProtocolStep::kLeave:
    case ProtocolStep::kPublish:
      return std::memory_order_release;
  }
  return std::memory_order_seq_cst;
}

/// Atomics and memory orders of the protocol's classes. These are templates over this type, so
/// that tests can run the same code over atomics that show every behaviour the language allows,
/// and with one order weakened at a time.
struct StdAtomics {
  template <class T>
  using Atomic = std::atomic<T>;

  static constexpr std::memory_order order(ProtocolStep step) noexcept { return order_of(step); }
};

/// Tells the writer whether one reader may hold pointers to frames.
///
/// The slot's sequence number is odd inside a section and even outside, and never repeats a value.
/// Pointers to frames are valid only within one section. So the writer, after hiding a page, notes
/// which slots have an odd number. Once each of these slots has another number, no reader can hold
/// a pointer to the page's frame. The reader never waits, loops or locks for this.
///
/// A reader must not find a page that the writer hides while the writer takes that reader for
/// outside:
///
///     reader                              writer
///     R1  sequence = odd                  E2  map[page] = 0
///     R2  frame = map[page]               E3  read sequence
///
/// Each side stores one variable and then loads the other's. With weaker orders both loads may
/// happen before either store becomes visible, on x86 too (store buffering), and both sides see
/// the old values. If all four are seq_cst, they have a single total order: if E3 does not see R1,
/// then E2 precedes R2 in that order, and R2 finds the page absent. These are operations instead
/// of fences because ThreadSanitizer does not model fences.
///
/// Each slot has a cache line of its own, so that readers do not slow each other down.
template <class Atomics = StdAtomics>
class alignas(64) BasicReaderSlot {
 public:
  /// Claims the slot for one reader; returns false if it is claimed already. Acquire, because the
  /// new reader continues the sequence and the counts of the last one.
  bool try_claim() noexcept {
    return !claimed_.exchange(true, Atomics::order(ProtocolStep::kClaim));
  }

  /// Releases the slot, outside of a section. Release, to hand sequence and counts to the next
  /// reader.
  void release() noexcept {
    assert(!inside());
    claimed_.store(false, Atomics::order(ProtocolStep::kRelease));
  }

  bool claimed() const noexcept { return claimed_.load(std::memory_order_relaxed); }

  // Only the reader that claimed the slot may make the following calls.

  /// Begins a section.
  void enter() noexcept {
    assert(!inside());
    // Only this reader stores, so its own load needs no order. The store is R1: seq_cst, for the
    // reason given above.
    const std::uint64_t sequence = sequence_.load(std::memory_order_relaxed);
    sequence_.store(sequence + 1, Atomics::order(ProtocolStep::kEnter));
  }

  /// Ends a section.
  void leave() noexcept {
    assert(inside());
    // R5: release, so that all reads of frames in this section happen before the writer, which
    // acquires this or a later number, writes the frame. Later operations need no order: if the
    // writer sees the store late, it only waits longer.
    const std::uint64_t sequence = sequence_.load(std::memory_order_relaxed);
    sequence_.store(sequence + 1, Atomics::order(ProtocolStep::kLeave));
  }

  bool inside() const noexcept { return is_inside(sequence_.load(std::memory_order_relaxed)); }

  /// Only this reader changes the counts, so a load and a store replace an atomic addition.
  /// Relaxed, because no other memory access depends on them.
  void count_hit() noexcept { add_one(hits_); }
  void count_miss() noexcept { add_one(misses_); }

  // The writer makes the following calls; any thread may read the counts.

  static constexpr bool is_inside(std::uint64_t sequence) noexcept { return sequence % 2 == 1; }

  /// E3: seq_cst, for the reason given above. Also acquires what the reader did in sections that
  /// have ended.
  std::uint64_t sequence_after_withdrawal() const noexcept {
    return sequence_.load(Atomics::order(ProtocolStep::kNoteSections));
  }

  /// E5: acquire, the other side of leave().
  std::uint64_t sequence_before_reuse() const noexcept {
    return sequence_.load(Atomics::order(ProtocolStep::kSeeSectionEnd));
  }

  std::uint64_t hits() const noexcept { return hits_.load(std::memory_order_relaxed); }
  std::uint64_t misses() const noexcept { return misses_.load(std::memory_order_relaxed); }

 private:
  using Number = typename Atomics::template Atomic<std::uint64_t>;

  static void add_one(Number& count) noexcept {
    count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }

  Number sequence_{0};
  Number hits_{0};
  Number misses_{0};
  typename Atomics::template Atomic<bool> claimed_{false};
};

using ReaderSlot = BasicReaderSlot<>;

static_assert(sizeof(ReaderSlot) == 64 && alignof(ReaderSlot) == 64);
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

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
  /// is one side of a store-buffering pair with withdraw(); see BasicReaderSlot.
  std::uint32_t find(std::uint32_t page) const noexcept {
    assert(page < count_);
    // 0 - 1 wraps to kNoFrame.
    return cells_[page].load(Atomics::order(ProtocolStep::kFind)) - 1;
  }

  /// Returns the map of the pages from `first` on, whose numbers then go from 0.
  BasicPageMap from(std::uint32_t first) const noexcept {
    assert(first <= count_);
    return BasicPageMap(std::span<Cell>(cells_ + first, count_ - first));
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
