#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace planetree::query {

/// The steps of SeqLock, below, at which the order of memory matters.
enum class SeqLockStep : std::uint8_t {
  kStoreWord,      ///< G2
  kStoreSequence,  ///< G3
  kLoadSequence,   ///< T1
  kLoadWord,       ///< T2
};

constexpr std::memory_order order_of(SeqLockStep step) noexcept {
  return step == SeqLockStep::kStoreWord || step == SeqLockStep::kStoreSequence
             ? std::memory_order_release
             : std::memory_order_acquire;
}

struct StdSeqLock {
  template <class T>
  using Atomic = std::atomic<T>;

  static constexpr std::memory_order order(SeqLockStep step) noexcept { return order_of(step); }
};

/// The latest of the values that one thread gives away; any number of others look for it. The
/// giver never waits, loops or locks; a value that nobody looked for in time is lost.
///
/// A sequence number is odd while words are written. Who finds the same even number before and
/// after reading the words has read those of one value:
///
///     giver                               taker
///     G1  sequence = odd                  T1  first = sequence
///     G2  words = value                   T2  read words
///     G3  sequence = even                 T3  sequence == first?
///
/// A taker that reads any word of G2 acquires what came before it, G1, and so sees at T3 that
/// the number has changed. What T1 acquires from G3 are the words before it. Words are released
/// and acquired one by one, where fences would do, because ThreadSanitizer does not model those;
/// on x86 it is the same code.
///
/// Value    of 8-byte words, trivially copyable.
/// Atomics  what it is made of; tests run it over atomics that show every behaviour the
///          language allows, and with one order weakened at a time.
template <class Value, class Atomics = StdSeqLock>
class alignas(64) SeqLock {
  static_assert(std::is_trivially_copyable_v<Value> && sizeof(Value) % sizeof(std::uint64_t) == 0);
  static constexpr std::size_t kWords = sizeof(Value) / sizeof(std::uint64_t);

 public:
  /// The giver alone.
  void store(const Value& value) noexcept {
    const auto words = std::bit_cast<std::array<std::uint64_t, kWords>>(value);
    const std::uint64_t sequence = sequence_.load(std::memory_order_relaxed);
    sequence_.store(sequence + 1, std::memory_order_relaxed);
    for (std::size_t i = 0; i < kWords; ++i)
      words_[i].store(words[i], Atomics::order(SeqLockStep::kStoreWord));
    sequence_.store(sequence + 2, Atomics::order(SeqLockStep::kStoreSequence));
  }

  /// Any thread: how many values were given so far.
  std::uint64_t store_count() const noexcept {
    return sequence_.load(std::memory_order_relaxed) / 2;
  }

  /// Any thread. False, and nothing changed, where there is no value newer than `seen`, which
  /// is 0 at first, or one is being written: to be looked for again later.
  bool load_newer(std::uint64_t& seen, Value& value) const noexcept {
    const std::uint64_t first = sequence_.load(Atomics::order(SeqLockStep::kLoadSequence));
    if (first == seen || first % 2 == 1) return false;
    std::array<std::uint64_t, kWords> words;
    for (std::size_t i = 0; i < kWords; ++i)
      words[i] = words_[i].load(Atomics::order(SeqLockStep::kLoadWord));
    if (sequence_.load(std::memory_order_relaxed) != first) return false;
    value = std::bit_cast<Value>(words);
    seen = first;
    return true;
  }

 private:
  using Word = typename Atomics::template Atomic<std::uint64_t>;

  Word sequence_{0};
  std::array<Word, kWords> words_{};
};

static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

}  // namespace planetree::query
