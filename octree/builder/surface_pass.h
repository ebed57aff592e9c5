#pragma once

#include <vector>

#include "octree/builder/cap_tree.h"
#include "octree/builder/job/build_memory.h"
#include "octree/builder/job/build_progress.h"
#include "octree/builder/job/model_frame.h"
#include "octree/builder/shard_results.h"
#include "octree/builder/shared_area_sums.h"
#include "octree/builder/sort/chunks.h"
#include "octree/builder/sort/triangle_runs.h"
#include "octree/builder/surface/cap_chain.h"
#include "octree/builder/surface/edge_balance.h"
#include "octree/builder/surface/region_cut.h"
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
  /// As run(), of a surface whose chunks others have looked at. There is no region.
  /// parts    all of the surface.
  /// scratch  has the edges of the parts attached; receives edges of caps.
  Result<SurfaceWork> join(const std::vector<ChunkResults>& parts, const BuildMemory& memory,
                           storage::SpillFile& scratch, BuildProgress& progress) const;

 private:
  Result<SurfaceWork> close(const EdgeBalance& edges, CapChain& boundary, RegionCut& cut,
                            const SharedAreaSums& areas) const;
};

}  // namespace planetree::octree
