#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "tests/cache/explorer/execution.h"

namespace planetree::explorer {

/// Replaces std::atomic of an integer or bool in an explored Program.
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
  T fetch_add(T value, std::memory_order order) noexcept {
    return static_cast<T>(
        Execution::current().fetch_add(atomic_, static_cast<std::uint64_t>(value), order));
  }

 private:
  std::size_t atomic_;
};

/// An ordinary variable that threads may share. The run fails on a data race: two accesses, at
/// least one of them a write, neither of which happens before the other.
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

/// Replaces std::mutex in an explored Program.
class Mutex {
 public:
  void lock() { Execution::current().lock(held_, knowledge_); }
  void unlock() { Execution::current().unlock(held_, knowledge_); }

 private:
  bool held_ = false;
  Knowledge knowledge_;
};

}  // namespace planetree::explorer
