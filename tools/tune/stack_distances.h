#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/tune/references.h"

namespace planetree::tools {

/// Misses of LRU at all sizes at once, by stack distances: the number of different pages looked up
/// since the last lookup of the same page, itself included. A lookup misses in a cache of fewer
/// frames. The root has a frame of its own.
class StackDistances {
 public:
  /// The exact distances of all lookups.
  static StackDistances of(const References& references);
  /// Misses of LRU in `frames` frames, one of which is the root's.
  ///
  /// frames  at least 2
  std::uint64_t misses(std::uint32_t frames) const {
    return misses_[std::min<std::size_t>(frames - 1, misses_.size() - 1)];
  }

 private:
  std::vector<std::uint64_t> misses_;  // by number of frames but the root's, from 0
};

}  // namespace planetree::tools
