#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "octree/builder/job/build_progress.h"
#include "octree/builder/sort/chunks.h"
#include "octree/builder/sort/triangle_runs.h"
#include "octree/builder/surface/cap_chain.h"
#include "octree/builder/surface/edge_balance.h"
#include "planetree/error.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// Receives the triangles of a chunk, in any order, on any thread.
using ChunkCall = std::function<Result<void>(const Triangles& triangles)>;

/// Balances the edges of a census that has seen all chunks of a model, and finds the faces of the
/// listed unbalanced edges. Arguments, errors and threads as those of match_edges().
Result<EdgeBalance> list_unbalanced(EdgeCensus& census, const TriangleRuns& runs,
                                    const std::vector<Chunk>& chunks, BuildProgress& progress,
                                    CapChain* boundary);

/// Matches the edges of a model, chunk by chunk, and finds the faces of the listed unbalanced
/// edges.
///
/// also        called for every chunk, once.
/// held_bytes  maximum of edges in memory that are left over by chunks.
/// scratch     receives the others.
/// boundary    receives every unbalanced edge; may be null.
/// errors      those of SpillFile, CapChain and `also`.
/// Uses the calling thread's TBB arena.
Result<EdgeBalance> match_edges(const TriangleRuns& runs, const std::vector<Chunk>& chunks,
                                std::uint64_t held_bytes, storage::SpillFile& scratch,
                                BuildProgress& progress, CapChain* boundary, const ChunkCall& also);

}  // namespace planetree::octree
