#pragma once

#include <vector>

#include "octree/builder/cap_tree.h"
#include "octree/builder/job/build_memory.h"
#include "octree/builder/job/build_progress.h"
#include "octree/builder/job/model_frame.h"
#include "octree/builder/sort/chunks.h"
#include "octree/builder/sort/triangle_runs.h"
#include "octree/builder/work_records.h"
#include "octree/geometry/cell_grid.h"
#include "planetree/error.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// The pass over the whole surface. It matches the edges, measures the openness, takes the
/// triangles of a region, and makes the caps. All members must outlive it.
struct SurfacePass {
  const ModelFrame& frame;
  const TriangleRuns& whole;
  const std::vector<Chunk>& chunks;  ///< of `whole`
  TriangleRuns* part;                ///< receives the triangles of the region; null: all are taken
  CapTree* caps;                     ///< receives the caps; null: they are not made

  /// scratch  receives edges that do not fit in memory.
  /// return   edges, cut and openness; the other members are empty.
  /// errors   those of match_edges() and CapTree::close().
  /// Uses the calling thread's TBB arena.
  Result<SurfaceWork> run(const Region& region, const BuildMemory& memory,
                          storage::SpillFile& scratch, BuildProgress& progress) const;
};

}  // namespace planetree::octree
