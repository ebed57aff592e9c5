#pragma once

#include <cstdint>

namespace planetree::explorer {

/// What is explored: threads over shared state, both made afresh for every run.
/// The state is made of Atomic, Plain and Mutex, set up by the constructor.
///
/// Threads must do the same whenever they read the same, and come to an end in
/// every run: so they wait a bounded number of times, each time by yield().
/// They own no memory: when a run fails, they stop in the middle, for good.
class Program {
 public:
  virtual ~Program() = default;

  /// At most kMaxThreads.
  virtual std::uint32_t thread_count() const noexcept = 0;

  /// The body of one thread.
  virtual void run(std::uint32_t thread) = 0;

  /// After all threads have ended and been joined.
  virtual void finish() {}
};

}  // namespace planetree::explorer
