#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include "planetree/model.h"

namespace planetree::octree {

/// The threads of one build. As in query/serve/batch_threads.cpp, oneTBB would warn of more threads
/// than it allows. Fewer are left to the arena, so that the caller's other work with oneTBB is not
/// slowed down.
class BuildThreads {
 public:
  /// count  number of threads, at least 1
  explicit BuildThreads(int count) {
    if (count > tbb::info::default_concurrency())
      limit_.emplace(kAllowed, std::size_t{OpenOptions::kMaxBatchThreads});
    const std::size_t allowed = tbb::global_control::active_value(kAllowed);
    arena_.initialize(std::min(count, static_cast<int>(allowed)));
  }

  /// Returns call(), which runs on these threads.
  template <class Call>
  auto run(const Call& call) {
    return arena_.execute(call);
  }

 private:
  static constexpr auto kAllowed = tbb::global_control::max_allowed_parallelism;

  std::optional<tbb::global_control> limit_;
  tbb::task_arena arena_;
};

}  // namespace planetree::octree
