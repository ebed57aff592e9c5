#pragma once

#include <cstdint>
#include <mutex>

#include "octree/builder/job/build_progress.h"

namespace planetree::octree {

/// Counts and reports the completed parts of a phase. Any number of threads may call add().
class PhaseCount {
 public:
  /// done  parts that are complete already, of `total`.
  PhaseCount(BuildProgress& progress, BuildPhase phase, std::uint64_t total, std::uint64_t done = 0)
      : progress_(progress), phase_(phase), total_(total), done_(done) {
    told_ = progress_.progress(phase_, done_, total_);
  }
  /// Returns an error if any report so far has returned one.
  Result<void> add() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (told_) told_ = progress_.progress(phase_, done_, total_);
    return told_;
  }

 private:
  BuildProgress& progress_;
  const BuildPhase phase_;
  const std::uint64_t total_;
  std::mutex mutex_;
  std::uint64_t done_;
  Result<void> told_;
};

}  // namespace planetree::octree
