#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "octree/builder/job/build_options.h"
#include "octree/builder/job/build_progress.h"
#include "octree/builder/job/model_frame.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/sort/attribute_spool.h"
#include "octree/builder/sort/frame_sink.h"
#include "octree/builder/sort/triangle_runs.h"
#include "planetree/build.h"
#include "planetree/error.h"

namespace planetree::octree {

/// A mesh that was read and sorted.
struct OrderedMesh {
  ModelFrame frame;
  std::uint64_t vertex_records = 0;
  bool wide_ids = false;                        ///< some index takes more than 32 bits
  std::vector<TriangleRuns::Extent> runs;       ///< the runs, if none of them is in memory
  std::vector<std::string> notes;               ///< as MeshSummary::notes
  SpooledAttributes attributes;                 ///< of all indices, if any are kept beside links
  ValueKind value_kind = ValueKind::kUnsigned;  ///< as MeshSummary::value_kind
  std::vector<std::uint64_t> file_indices;      ///< as MeshSummary::file_indices
};

/// Reads a mesh without sorting it.
///
/// scratch  as for read_mesh(). After an error, MeshScratch::file() is the file that it concerns;
///          empty if there is none.
/// sink     receives the triangles.
/// kept     receives the attributes that options.keep names.
/// return   everything but the runs.
/// errors   those of read_mesh() and the sink; kBadInput for a bad record under
///          options.strict.
Result<OrderedMesh> read_unordered(const BuildInput& input, const BuildOptions& options,
                                   MeshScratch& scratch, BuildProgress& progress, FrameSink& sink,
                                   storage::SpillFile& kept);

}  // namespace planetree::octree
