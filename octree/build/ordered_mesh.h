#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "octree/build/build_options.h"
#include "octree/build/build_progress.h"
#include "octree/build/mesh_intake.h"
#include "octree/build/mesh_scratch.h"
#include "octree/build/model_frame.h"
#include "octree/build/triangle_runs.h"
#include "planetree/error.h"

namespace planetree::octree {

/// A mesh, read and ordered.
struct OrderedMesh {
  ModelFrame frame;
  std::uint64_t vertex_records = 0;
  bool wide_ids = false;                  ///< some triangle's index takes more than 32 bits
  std::vector<TriangleRuns::Place> runs;  ///< if none of them is in memory
};

/// Reads the mesh at `input`, which is not ordered then.
///
/// scratch  as read_mesh() has it.
/// intake   takes its triangles.
/// return   all but the runs.
/// errors   those of read_mesh and MeshIntake; kBadInput for a bad record under options.strict.
Result<OrderedMesh> read_unordered(const std::filesystem::path& input, const BuildOptions& options,
                                   MeshScratch& scratch, BuildProgress& progress,
                                   MeshIntake& intake);

}  // namespace planetree::octree
