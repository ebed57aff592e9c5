#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include "planetree/model.h"

namespace planetree::octree {

/// Calls work() in a TBB arena of so many threads, and returns what it returns.
///
/// As query/serve/batch_threads.cpp does: oneTBB warns of more threads than it allows. Fewer are
/// left to the arena, so that the caller's other work with oneTBB is not slowed down.
template <class Work>
auto in_build_arena(int threads, const Work& work) {
  constexpr auto kAllowed = tbb::global_control::max_allowed_parallelism;
  std::optional<tbb::global_control> limit;
  if (threads > tbb::info::default_concurrency())
    limit.emplace(kAllowed, std::size_t{OpenOptions::kMaxBatchThreads});
  const std::size_t allowed = tbb::global_control::active_value(kAllowed);
  tbb::task_arena arena(std::min(threads, static_cast<int>(allowed)));
  return arena.execute(work);
}

}  // namespace planetree::octree
