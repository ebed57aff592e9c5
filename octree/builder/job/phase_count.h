#pragma once

#include <cstdint>
#include <mutex>

#include "octree/builder/job/build_progress.h"

namespace planetree::octree {

/// Counts the parts of a phase that are done. Any number of threads may add().
class PhaseCount {
 public:
  /// done  already, of `total`.
  PhaseCount(BuildProgress& progress, BuildPhase phase, std::uint64_t total, std::uint64_t done = 0)
      : progress_(progress), phase_(phase), total_(total), done_(done) {
    progress_.progress(phase_, done_, total_);
  }
  void add() {
    const std::lock_guard lock(mutex_);
    progress_.progress(phase_, ++done_, total_);
  }

 private:
  BuildProgress& progress_;
  const BuildPhase phase_;
  const std::uint64_t total_;
  std::mutex mutex_;
  std::uint64_t done_;
};

}  // namespace planetree::octree
