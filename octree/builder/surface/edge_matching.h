#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "octree/builder/job/build_progress.h"
#include "octree/builder/sort/chunks.h"
#include "octree/builder/sort/triangle_runs.h"
#include "octree/builder/surface/edge_balance.h"
#include "planetree/error.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// Certain of the triangles of a patch, in any order; on any thread.
using ChunkCall = std::function<Result<void>(const Triangles& triangles)>;

/// Matches the edges of a model, patch by patch, and looks for the faces of those that are open.
///
/// also        given every patch once, on the way.
/// held_bytes  of edges that patches have in common may stay in memory.
/// scratch     takes the others.
/// errors      those of SpillFile and `also`.
/// Uses the calling thread's TBB arena.
Result<EdgeBalance> match_edges(const TriangleRuns& runs, const std::vector<Chunk>& chunks,
                                std::uint64_t held_bytes, storage::SpillFile& scratch,
                                BuildProgress& progress, const ChunkCall& also);

}  // namespace planetree::octree
