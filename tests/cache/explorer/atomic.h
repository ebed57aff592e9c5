#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "tests/cache/explorer/execution.h"

namespace planetree::explorer {

/// Stands in for std::atomic of an integer or bool in a Program.
template <class T>
class Atomic {
  static_assert(std::is_integral_v<T>);

 public:
  Atomic(T value = T()) noexcept
      : atomic_(Execution::current().add_atomic(static_cast<std::uint64_t>(value))) {}
  Atomic(const Atomic&) = delete;
  Atomic& operator=(const Atomic&) = delete;

  T load(std::memory_order order) const noexcept {
    return static_cast<T>(Execution::current().load(atomic_, order));
  }
  void store(T value, std::memory_order order) noexcept {
    Execution::current().store(atomic_, static_cast<std::uint64_t>(value), order);
  }
  T exchange(T value, std::memory_order order) noexcept {
    return static_cast<T>(
        Execution::current().exchange(atomic_, static_cast<std::uint64_t>(value), order));
  }

 private:
  std::size_t atomic_;
};

/// An ordinary variable that threads may share: two accesses, one of them a
/// write, of which neither happens before the other, fail the run.
template <class T>
class Plain {
 public:
  Plain(T value = T()) : plain_(Execution::current().add_plain()), value_(value) {}
  Plain(const Plain&) = delete;
  Plain& operator=(const Plain&) = delete;

  T read() const {
    Execution::current().read_plain(plain_);
    return value_;
  }
  void write(T value) {
    Execution::current().write_plain(plain_);
    value_ = value;
  }

 private:
  std::size_t plain_;
  T value_;
};

/// Stands in for std::mutex.
class Mutex {
 public:
  void lock() { Execution::current().lock(held_, told_); }
  void unlock() { Execution::current().unlock(held_, told_); }

 private:
  bool held_ = false;
  Knowledge told_;
};

}  // namespace planetree::explorer
