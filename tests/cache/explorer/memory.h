#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/cache/explorer/choices.h"
#include "tests/cache/explorer/knowledge.h"
#include "tests/cache/explorer/seq_cst_order.h"

namespace planetree::explorer {

/// The memory of one run, as C++20 defines it ([intro.races], [atomics.order]):
/// an atomic keeps every store ever made to it, and a load may return any that
/// it cannot rule out. Of plain variables it knows only who touched them when,
/// to find data races; their values are kept elsewhere.
///
/// What it does not show, though the language allows it:
/// - loads of stores executed later (load buffering; relaxed loads only);
/// - stores by several threads to one atomic that take their places in its
///   modification order otherwise than as executed. With one writing thread,
///   or threads that exclude each other, there is no other way.
/// Of read-modify-writes it has exchange; it has no fences.
class Memory {
 public:
  /// What a load found.
  struct Loaded {
    std::uint64_t value;
    std::size_t newer_stores;  ///< than the one it returned
  };

  /// Forgets everything.
  void clear() noexcept;

  std::size_t add_atomic(std::uint64_t value);
  std::size_t add_plain();

  // A step of a thread each. `thread` is below kMaxThreads.

  Loaded load(std::uint32_t thread, std::size_t atomic, std::memory_order order, Choices& choices);
  void store(std::uint32_t thread, std::size_t atomic, std::uint64_t value,
             std::memory_order order);
  std::uint64_t exchange(std::uint32_t thread, std::size_t atomic, std::uint64_t value,
                         std::memory_order order);

  /// False if this races with a write by another thread.
  [[nodiscard]] bool read_plain(std::uint32_t thread, std::size_t plain);
  /// False if this races with a read or a write by another thread.
  [[nodiscard]] bool write_plain(std::uint32_t thread, std::size_t plain);

  /// What a thread knows, for another to learn: mutexes, starts and ends of
  /// threads.
  Knowledge tell(std::uint32_t thread);
  void learn(std::uint32_t thread, const Knowledge& knowledge) noexcept;

  std::uint16_t time_of(std::uint32_t thread) const noexcept {
    return known_[thread].time_of(thread);
  }

 private:
  using Set = SeqCstOrder::Set;

  struct Store {
    std::uint64_t value;
    Knowledge released;     ///< what a load with acquire learns from it
    Set seq_cst_store = 0;  ///< itself, if it is one
    Set seq_cst_loads = 0;  ///< that returned it
  };
  using History = std::vector<Store>;

  struct Plain {
    Step written;
    std::array<std::uint16_t, kMaxThreads> read{};
  };

  Step next_step(std::uint32_t thread) noexcept;
  static Set coherence_before(const History& history, std::size_t store) noexcept;
  static Set coherence_after(const History& history, std::size_t store) noexcept;
  void append(std::uint32_t thread, std::size_t atomic, Store made, std::memory_order order);

  std::array<Knowledge, kMaxThreads> known_;
  std::array<History, kMaxAtomics> histories_;
  std::size_t atomic_count_ = 0;
  std::vector<Plain> plains_;
  SeqCstOrder order_;
  std::vector<std::uint32_t> candidates_;
};

}  // namespace planetree::explorer
