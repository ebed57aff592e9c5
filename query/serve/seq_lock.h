#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace planetree::query {

/// The steps of SeqLock at which memory order matters.
enum class SeqLockStep : std::uint8_t {
  kStoreWord,      ///< W2
  kStoreSequence,  ///< W3
  kLoadSequence,   ///< R1
  kLoadWord,       ///< R2
};

constexpr std::memory_order order_of(SeqLockStep step) noexcept {
  return step == SeqLockStep::kStoreWord || step == SeqLockStep::kStoreSequence
             ? std::memory_order_release
             : std::memory_order_acquire;
}

/// The atomics of a SeqLock outside of tests.
struct StdSeqLock {
  template <class T>
  using Atomic = std::atomic<T>;

  static constexpr std::memory_order order(SeqLockStep step) noexcept { return order_of(step); }
};

/// A value that one thread, the writer, overwrites and any number of readers copy. The writer never
/// waits, loops or locks. A value that is overwritten before a reader has copied it is lost.
///
/// A sequence number is odd while words are written. A reader that finds the same even number
/// before and after reading the words has read the words of one value:
///
///     writer                              reader
///     W1  sequence = odd                  R1  first = sequence
///     W2  words = value                   R2  read words
///     W3  sequence = even                 R3  sequence == first?
///
/// A reader that reads a word written in W2 acquires W1, which came before it, and so sees at R3
/// that the number has changed. A reader that reads the number of W3 at R1 acquires the words of
/// W2. Words are released and acquired one by one, although fences would suffice, because
/// ThreadSanitizer does not model fences; on x86 the code is the same.
///
/// Value    trivially copyable, a multiple of 8 bytes long
/// Atomics  the atomic types. Tests run it with atomics that show every behaviour the language
///          allows, and with one memory order weakened at a time.
template <class Value, class Atomics = StdSeqLock>
class alignas(64) SeqLock {
  static_assert(std::is_trivially_copyable_v<Value> && sizeof(Value) % sizeof(std::uint64_t) == 0);
  static constexpr std::size_t kWords = sizeof(Value) / sizeof(std::uint64_t);

 public:
  /// Overwrites the value. For the writer only.
  void store(const Value& value) noexcept {
    const auto words = std::bit_cast<std::array<std::uint64_t, kWords>>(value);
    const std::uint64_t sequence = sequence_.load(std::memory_order_relaxed);
    sequence_.store(sequence + 1, std::memory_order_relaxed);
    for (std::size_t i = 0; i < kWords; ++i)
      words_[i].store(words[i], Atomics::order(SeqLockStep::kStoreWord));
    sequence_.store(sequence + 2, Atomics::order(SeqLockStep::kStoreSequence));
  }

  /// Returns the number of values stored so far. Any thread may call it.
  std::uint64_t store_count() const noexcept {
    return sequence_.load(std::memory_order_relaxed) / 2;
  }

  /// Copies the value if it is newer than `seen`, and updates `seen`. Returns false and changes
  /// nothing if there is no newer value or if one is being written; try again later. Any thread may
  /// call it.
  ///
  /// seen  sequence number of the last value that this reader copied; 0 at first
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
