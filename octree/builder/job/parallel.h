#pragma once

#include <cstddef>
#include <mutex>
#include <optional>

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include "planetree/error.h"

namespace planetree::octree {

/// Calls work(i), which returns Result<void>, for every i below `count`, roughly in order. Uses the
/// calling thread's TBB arena; each thread works on one i at a time.
///
/// return  the error of one of the calls; no further call begins after it.
template <class Work>
Result<void> for_each_in_parallel(std::size_t count, const Work& work) {
  std::mutex mutex;
  std::optional<Error> failure;
  std::size_t next = 0;
  // Takes the next index instead of the one that TBB gives, so that the indices in work at one time
  // are close together.
  const auto take = [&]() -> std::optional<std::size_t> {
    const std::lock_guard lock(mutex);
    if (failure) return {};
    return next++;
  };
  tbb::parallel_for(
      std::size_t{0}, count,
      [&](std::size_t) {
        const auto at = take();
        if (!at) return;
        const Result<void> done = work(*at);
        const std::lock_guard lock(mutex);
        if (!done && !failure) failure = done.error();
      },
      tbb::simple_partitioner());
  if (failure) return *failure;
  return {};
}

}  // namespace planetree::octree
