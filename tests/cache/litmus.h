#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <vector>

#include "tests/cache/explorer/atomic.h"
#include "tests/cache/explorer/explore.h"

namespace planetree::explorer {

inline constexpr auto kRelaxed = std::memory_order_relaxed;
inline constexpr auto kAcquire = std::memory_order_acquire;
inline constexpr auto kRelease = std::memory_order_release;
inline constexpr auto kSeqCst = std::memory_order_seq_cst;

/// What the threads of a litmus test share: a few variables, enough to distinguish what memory may
/// do from what it may not, and the values found.
struct Litmus {
  Atomic<int> x{0}, y{0}, z{0};
  Plain<int> a{0}, b{0};
  Mutex mutex;
  std::vector<int> found = std::vector<int>(4, -1);
};

using Body = std::function<void(Litmus&)>;
using Outcomes = std::set<std::vector<int>>;

/// Records the values found in each run.
class LitmusProgram final : public Program {
 public:
  LitmusProgram(const std::vector<Body>& bodies, Outcomes& outcomes)
      : bodies_(bodies), outcomes_(outcomes) {}
  std::uint32_t thread_count() const noexcept override {
    return static_cast<std::uint32_t>(bodies_.size());
  }
  void run(std::uint32_t thread) override { bodies_[thread](litmus_); }
  void finish() override { outcomes_.insert(litmus_.found); }

 private:
  const std::vector<Body>& bodies_;
  Outcomes& outcomes_;
  Litmus litmus_;
};

/// All outcomes of a litmus test.
struct Explored {
  Outcomes outcomes;
  Report report;

  /// Values missing at the end of `found` count as -1.
  bool finds(const std::vector<int>& found) const {
    std::vector<int> padded = found;
    padded.resize(4, -1);
    return outcomes.contains(padded);
  }
};

/// Explores every run of threads with these bodies.
inline Explored explore_threads(const std::vector<Body>& bodies) {
  Explored explored;
  explored.report = explore_all(
      [&] { return std::make_unique<LitmusProgram>(bodies, explored.outcomes); }, kAnyPreemptions);
  return explored;
}

}  // namespace planetree::explorer
