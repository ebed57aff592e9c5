#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>

namespace planetree::query {

/// Where a TraceClock gets the time: nanoseconds that never decrease. A default one is the time
/// since it was made.
struct TimeSource {
  std::uint64_t (*time_ns)(const void* context) noexcept = &steady_time;
  const void* context = nullptr;

  static std::uint64_t steady_time(const void* /*context*/) noexcept {
    const auto time = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(time).count());
  }
};

/// The time of a page trace, which real-time queries read with one load. Threads that may make
/// system calls advance it: fetch threads, threads that read pages, the thread that drains.
///
/// Accessed with relaxed order: a reader that learns of an event by other means may see the time
/// before it. Any thread may call all functions.
class TraceClock {
 public:
  /// Sets the time to 0. Call it before other threads use the clock.
  void start(TimeSource source) noexcept {
    source_ = source;
    start_ns_ = source.time_ns(source.context);
  }

  std::uint64_t now() const noexcept { return now_.load(std::memory_order_relaxed); }
  /// Advances the clock to the time of the source.
  void advance() noexcept { advance(0); }
  /// Advances the clock by at least 1 ns. Returns the new time, which no other call returns.
  std::uint64_t tick() noexcept { return advance(1); }

 private:
  std::uint64_t advance(std::uint64_t least) noexcept {
    const std::uint64_t time = source_.time_ns(source_.context) - start_ns_;
    std::uint64_t now = now_.load(std::memory_order_relaxed), next = 0;
    do {
      next = std::max(time, now + least);
    } while (!now_.compare_exchange_weak(now, next, std::memory_order_relaxed));
    return next;
  }

  std::atomic<std::uint64_t> now_{0};
  TimeSource source_;
  std::uint64_t start_ns_ = 0;
};

}  // namespace planetree::query
