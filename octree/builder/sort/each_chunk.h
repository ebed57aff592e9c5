#pragma once

#include <cstddef>
#include <vector>

#include "octree/builder/job/build_progress.h"
#include "octree/builder/job/parallel.h"
#include "octree/builder/job/phase_count.h"
#include "octree/builder/sort/chunks.h"
#include "octree/builder/sort/triangle_runs.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Calls work(number, triangles in any order) for each chunk that is not done already, on any
/// thread. Counts chunks as the parts of a phase. Uses the calling thread's TBB arena.
///
/// is_done  (number) -> bool, called for every chunk before any work.
/// errors   those of SpillFile, `progress` and `work`.
template <class IsDone, class Work>
Result<void> for_each_chunk(const TriangleRuns& runs, const std::vector<Chunk>& chunks,
                            BuildProgress& progress, BuildPhase phase, const IsDone& is_done,
                            const Work& work) {
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < chunks.size(); ++i)
    if (!is_done(i)) left.push_back(i);
  PhaseCount count(progress, phase, chunks.size(), chunks.size() - left.size());
  return for_each_in_parallel(left.size(), [&](std::size_t i) -> Result<void> {
    const Chunk& chunk = chunks[left[i]];
    auto triangles = runs.read_any_order(chunk.from, chunk.to);
    if (!triangles) return triangles.error();
    if (const Result<void> done = work(left[i], *triangles); !done) return done;
    return count.add();
  });
}

}  // namespace planetree::octree
