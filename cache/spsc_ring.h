#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

namespace planetree::cache {

/// The steps of SpscRing, below, at which the order of memory matters.
enum class RingStep : std::uint8_t {
  kShow,     ///< G3
  kSee,      ///< T1
  kFree,     ///< T3
  kSeeFree,  ///< G1
};

constexpr std::memory_order order_of(RingStep step) noexcept {
  return step == RingStep::kShow || step == RingStep::kFree ? std::memory_order_release
                                                            : std::memory_order_acquire;
}

struct StdRing {
  template <class T>
  using Atomic = std::atomic<T>;

  template <class T>
  class Plain {
   public:
    T read() const noexcept { return value_; }
    void write(const T& value) noexcept { value_ = value; }

   private:
    T value_{};
  };

  static constexpr std::memory_order order(RingStep step) noexcept { return order_of(step); }
};

/// Records on their way from one thread to another. The giver never waits, loops or locks: what
/// finds no room is dropped, and counted.
///
///     giver                               taker
///     G1  taken                           T1  given
///     G2  write the slot, if one is free  T2  read the slots up to there
///     G3  given = one more                T3  taken = so many more
///
/// T1 acquires from G3 what was written at G2; G1 acquires from T3 that T2 is over.
///
/// A view of slots that somebody else owns. Atomics as SeqLock has them: for tests.
template <class Record, class Atomics = StdRing>
class alignas(64) SpscRing {
 public:
  using Slot = typename Atomics::template Plain<Record>;

  /// As many as hold so many records: a power of two.
  static constexpr std::uint64_t slots_for(std::uint64_t records) { return std::bit_ceil(records); }

  /// Before there are threads. `slots` is a power of two of them, or none: all is dropped then.
  void attach(std::span<Slot> slots) noexcept {
    assert(slots.empty() || std::has_single_bit(slots.size()));
    slots_ = slots;
  }

  /// The giver alone.
  void give(const Record& record) noexcept {
    const std::uint64_t given = given_.load(std::memory_order_relaxed);
    if (given - taken_.load(Atomics::order(RingStep::kSeeFree)) == slots_.size()) {
      dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return;
    }
    slots_[given & (slots_.size() - 1)].write(record);
    given_.store(given + 1, Atomics::order(RingStep::kShow));
  }

  /// The taker alone: the oldest records, in their order; how many there were, or room for.
  std::size_t take(std::span<Record> records) noexcept {
    const std::uint64_t given = given_.load(Atomics::order(RingStep::kSee));
    const std::uint64_t taken = taken_.load(std::memory_order_relaxed);
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(given - taken, records.size()));
    for (std::size_t i = 0; i < count; ++i)
      records[i] = slots_[(taken + i) & (slots_.size() - 1)].read();
    taken_.store(taken + count, Atomics::order(RingStep::kFree));
    return count;
  }

  /// Any thread.
  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  using Number = typename Atomics::template Atomic<std::uint64_t>;

  std::span<Slot> slots_;
  Number given_{0};
  Number dropped_{0};
  alignas(64) Number taken_{0};  // so that the taker does not disturb the giver's line
};

}  // namespace planetree::cache
