#pragma once

#include <cstdint>

namespace planetree::explorer {

/// The program to explore: threads over shared state. Both are created anew for every run; the
/// constructor sets up the state, which consists of Atomic, Plain and Mutex.
///
/// Threads must be deterministic in what they read, and must end in every run: they wait a bounded
/// number of times, each time by yield(). They must own no memory, because a failed run abandons
/// them in the middle.
class Program {
 public:
  virtual ~Program() = default;

  /// Number of threads, at most kMaxThreads.
  virtual std::uint32_t thread_count() const noexcept = 0;

  /// Body of one thread.
  virtual void run(std::uint32_t thread) = 0;

  /// Runs after all threads have ended and been joined.
  virtual void finish() {}
};

}  // namespace planetree::explorer
