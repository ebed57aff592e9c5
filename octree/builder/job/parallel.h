#pragma once

#include <cstddef>
#include <mutex>
#include <optional>

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include "planetree/error.h"

namespace planetree::octree {

/// Calls work(i), which returns Result<void>, for every i below `count`, about in order. A
/// thread of the calling thread's TBB arena works on one at a time.
///
/// return  an error of one of them: others may not have been called then.
template <class Work>
Result<void> for_each_in_parallel(std::size_t count, const Work& work) {
  std::mutex mutex;
  std::optional<Error> failure;
  std::size_t next = 0;
  // Not the index that TBB gives, but the next: what is worked on at a time is close together.
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
