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

/// The memory of one run, as C++20 defines it ([intro.races], [atomics.order]). An atomic keeps
/// every store ever made to it, and a load may return any store that the standard does not rule
/// out. Of plain variables only the accesses are recorded, to find data races; their values are
/// kept elsewhere.
///
/// Behaviours that the language allows and this does not show:
/// - loads of stores that are executed later (load buffering; relaxed loads only);
/// - modification orders that differ from the order of execution where several threads store to one
///   atomic. With one writing thread, or with threads that exclude each other, they cannot differ.
/// The only read-modify-writes are exchange and fetch_add. There are no fences.
class Memory {
 public:
  /// Result of a load.
  struct Loaded {
    std::uint64_t value;
    std::size_t newer_stores;  ///< stores newer than the one returned
  };

  /// Removes all variables and everything known about them.
  void clear() noexcept;

  std::size_t add_atomic(std::uint64_t value);
  std::size_t add_plain();

  // Each call is one step of a thread. `thread` is below kMaxThreads.

  Loaded load(std::uint32_t thread, std::size_t atomic, std::memory_order order, Choices& choices);
  void store(std::uint32_t thread, std::size_t atomic, std::uint64_t value,
             std::memory_order order);
  std::uint64_t exchange(std::uint32_t thread, std::size_t atomic, std::uint64_t value,
                         std::memory_order order);
  std::uint64_t fetch_add(std::uint32_t thread, std::size_t atomic, std::uint64_t value,
                          std::memory_order order) {
    return exchange(thread, atomic, histories_[atomic].back().value + value, order);
  }

  /// False if this races with a write by another thread.
  [[nodiscard]] bool read_plain(std::uint32_t thread, std::size_t plain);
  /// False if this races with a read or a write by another thread.
  [[nodiscard]] bool write_plain(std::uint32_t thread, std::size_t plain);

  /// Returns what a thread knows, for another thread to learn(): for mutexes, and for starts and
  /// joins of threads.
  Knowledge publish_knowledge(std::uint32_t thread);
  void learn(std::uint32_t thread, const Knowledge& knowledge) noexcept;

  std::uint16_t time_of(std::uint32_t thread) const noexcept {
    return known_[thread].time_of(thread);
  }

 private:
  using Set = SeqCstOrder::Set;

  struct Store {
    std::uint64_t value;
    Knowledge released;     ///< what an acquire load of it learns
    Set seq_cst_store = 0;  ///< this store, if it is seq_cst
    Set seq_cst_loads = 0;  ///< seq_cst loads that returned it
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
