#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

namespace planetree::cache {

/// Steps of SpscRing, below, at which the memory order matters.
enum class RingStep : std::uint8_t {
  kPublishRecord,  ///< P3
  kSeeRecords,     ///< C1
  kFreeSlots,      ///< C3
  kSeeFreeSlots,   ///< P1
};

constexpr std::memory_order order_of(RingStep step) noexcept {
  return step == RingStep::kPublishRecord || step == RingStep::kFreeSlots
             ? std::memory_order_release
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

/// A ring buffer with a single producer and a single consumer. The producer never waits, loops or
/// locks: it drops and counts a record that finds the ring full. Each side has a counter of the
/// records it has written or read.
///
///     producer                            consumer
///     P1  load the consumer's counter     C1  load the producer's counter
///     P2  write slots, if they are free   C2  read the slots up to it
///     P3  increase its own counter        C3  increase its own counter
///
/// C1 acquires from P3 the slots written at P2. P1 acquires from C3 that the reads of C2 are over.
/// The producer repeats P1 only where it has used up the slots that it saw free, and may write any
/// number of records before P3. It may change a record until then.
///
/// A view of slots; the caller owns them. The Atomics parameter is for tests, as in SeqLock.
template <class Record, class Atomics = StdRing>
class alignas(64) SpscRing {
 public:
  using Slot = typename Atomics::template Plain<Record>;

  /// Number of slots that hold at least `records` records: a power of two.
  static constexpr std::uint64_t slots_for(std::uint64_t records) { return std::bit_ceil(records); }

  /// Sets the slots, before threads use the ring. Their number is a power of two, or 0: then all
  /// records are dropped.
  void attach(std::span<Slot> slots) noexcept {
    assert(slots.empty() || std::has_single_bit(slots.size()));
    slots_ = slots;
  }

  /// Adds a record, or drops it if the ring is full. For the producer.
  void push(const Record& record) noexcept {
    if (has_room(1) || find_room(1)) {
      stage(record);
      publish();
    } else {
      drop();
    }
  }

  // The steps of push(), for a producer that publishes several records at once.

  /// Whether so many more records fit into the slots that are known to be free.
  bool has_room(std::uint64_t records) const noexcept { return limit_ - staged_ >= records; }
  /// Does the same after it has looked for slots that the consumer has freed.
  bool find_room(std::uint64_t records) noexcept {
    limit_ = popped_.load(Atomics::order(RingStep::kSeeFreeSlots)) + slots_.size();
    return has_room(records);
  }
  /// Adds a record that the consumer does not see before publish(). Needs has_room(1).
  void stage(const Record& record) noexcept {
    assert(has_room(1));
    slots_[staged_ & (slots_.size() - 1)].write(record);
    ++staged_;
  }
  /// Shows all staged records to the consumer.
  void publish() noexcept { pushed_.store(staged_, Atomics::order(RingStep::kPublishRecord)); }
  /// Counts a record that found no room.
  void drop() noexcept {
    dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }

  /// Makes has_room() say no until find_room() is called.
  void forget_room() noexcept { limit_ = staged_; }

  /// Number of records staged so far, the published ones included: the place of the next one.
  std::uint64_t staged() const noexcept { return staged_; }
  /// Number of records published so far: the place of the first one that may be changed.
  std::uint64_t published() const noexcept { return pushed_.load(std::memory_order_relaxed); }
  /// The record at a place, which must be staged and not yet published.
  Record staged(std::uint64_t place) const noexcept {
    assert(place < staged_);
    return slots_[place & (slots_.size() - 1)].read();
  }
  /// Replaces that record.
  void restage(std::uint64_t place, const Record& record) noexcept {
    assert(place < staged_);
    slots_[place & (slots_.size() - 1)].write(record);
  }

  /// Empties the ring and forgets what was dropped. While no other thread uses it.
  void clear() noexcept {
    publish();
    popped_.store(staged_, Atomics::order(RingStep::kFreeSlots));
    dropped_.store(0, std::memory_order_relaxed);
  }

  /// Removes the oldest records into `records`, in the order in which they were added. Returns
  /// their number, at most records.size(). For the consumer.
  std::size_t pop(std::span<Record> records) noexcept {
    const std::uint64_t pushed = pushed_.load(Atomics::order(RingStep::kSeeRecords));
    const std::uint64_t popped = popped_.load(std::memory_order_relaxed);
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(pushed - popped, records.size()));
    for (std::size_t i = 0; i < count; ++i)
      records[i] = slots_[(popped + i) & (slots_.size() - 1)].read();
    popped_.store(popped + count, Atomics::order(RingStep::kFreeSlots));
    return count;
  }

  /// Number of records dropped so far. For any thread.
  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  using Number = typename Atomics::template Atomic<std::uint64_t>;

  std::span<Slot> slots_;
  std::uint64_t staged_ = 0;  // the producer's own
  std::uint64_t limit_ = 0;   // staged_ may grow up to here, as the producer knows
  Number pushed_{0};
  Number dropped_{0};
  alignas(64) Number popped_{0};  // on a line of its own, away from what the producer writes
};

}  // namespace planetree::cache
