#pragma once

#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "cache/protocol_step.h"

namespace planetree::cache {

/// Tells the writer whether one reader may be holding frames.
///
/// A reader's life is a row of sections. The sequence is odd inside a section
/// and even outside, and never repeats a value. Pointers to frames live only
/// inside one section. So the writer, having hidden a page, notes which slots
/// are odd: once each of these shows another number, nobody can hold the
/// page's frame any more. The reader never waits, loops or locks for this.
///
/// What must not happen is that a reader finds a page which the writer hides,
/// while the writer takes that reader for outside:
///
///     reader                              writer
///     R1  sequence = odd                  E2  map[page] = 0
///     R2  frame = map[page]               E3  read sequence
///
/// Each side stores one variable and then loads the other's. With weaker
/// orders both loads may come before both stores become visible, on x86 too
/// (store buffering), and both sides see the old values. Making all four
/// seq_cst puts them in one order: if E3 misses R1, then E2 precedes R2 in it,
/// and R2 finds the page absent. These are operations and not fences because
/// ThreadSanitizer does not model fences.
///
/// One slot a cache line, so that readers do not disturb each other.
template <class Atomics = StdAtomics>
class alignas(64) BasicReaderSlot {
 public:
  /// Takes the slot for one reader; false if it is taken. Acquire: the new
  /// owner continues the sequence and the counts where the last one stopped.
  bool try_claim() noexcept {
    return !claimed_.exchange(true, Atomics::order(ProtocolStep::kClaim));
  }

  /// Gives the slot up, outside a section. Release: hands sequence and counts
  /// to the next owner.
  void release() noexcept {
    assert(!inside());
    claimed_.store(false, Atomics::order(ProtocolStep::kGiveUp));
  }

  bool claimed() const noexcept { return claimed_.load(std::memory_order_relaxed); }

  // The calls below, up to the writer's, belong to the slot's owner.

  /// Begins a section.
  void enter() noexcept {
    assert(!inside());
    // Only the owner stores, so its own load needs no order. R1: seq_cst, as
    // argued above.
    const std::uint64_t sequence = sequence_.load(std::memory_order_relaxed);
    sequence_.store(sequence + 1, Atomics::order(ProtocolStep::kEnter));
  }

  /// Ends a section.
  void leave() noexcept {
    assert(inside());
    // R5: release, so that all reads of frames in this section are over before
    // the writer, which acquires this or a later number, writes the frame.
    // Nothing after it needs to be ordered before it: seen late, it only makes
    // the writer wait longer.
    const std::uint64_t sequence = sequence_.load(std::memory_order_relaxed);
    sequence_.store(sequence + 1, Atomics::order(ProtocolStep::kLeave));
  }

  bool inside() const noexcept { return is_inside(sequence_.load(std::memory_order_relaxed)); }

  /// The counts have one writer each, so a load and a store will do in place
  /// of a locked addition; relaxed, since nothing is concluded from them.
  void count_hit() noexcept { add_one(hits_); }
  void count_miss() noexcept { add_one(misses_); }

  // For the writer, and for statistics.

  static constexpr bool is_inside(std::uint64_t sequence) noexcept { return sequence % 2 == 1; }

  /// E3: seq_cst, as argued above; also acquires what the reader did in
  /// sections that are over.
  std::uint64_t sequence_after_withdrawal() const noexcept {
    return sequence_.load(Atomics::order(ProtocolStep::kSeeOpen));
  }

  /// E5: acquire, the other half of leave().
  std::uint64_t sequence_before_reuse() const noexcept {
    return sequence_.load(Atomics::order(ProtocolStep::kSeeOver));
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

}  // namespace planetree::cache
