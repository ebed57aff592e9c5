#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "octree/builder/job/build_options.h"
#include "octree/builder/job/build_progress.h"
#include "octree/builder/job/model_frame.h"
#include "octree/builder/mask/built_mask.h"
#include "octree/builder/sort/chunks.h"
#include "octree/builder/surface/edge_balance.h"
#include "octree/builder/surface/region_cut.h"
#include "octree/builder/tree/built_tree.h"
#include "octree/builder/tree/chunk_build.h"
#include "octree/page/frame.h"
#include "planetree/error.h"
#include "storage/file/file_layout.h"

namespace planetree::octree {

/// A model of which all parts are built.
struct BuiltModel {
  ModelFrame frame;
  std::uint64_t vertex_records = 0;
  BlockShape shape;
  EdgeBalance edges;  ///< of the whole input, as the frame is
  SurfaceCut cut;
  std::optional<RegionBox> box;
  ChunkTree above;
  std::vector<BuiltChunk> chunks;  ///< as above.patches
  std::optional<BuiltMask> mask;   ///< of a watertight model
};

/// Puts the parts together and writes the file, whole or not at all.
///
/// tree     of the model's patches.
/// calls    the system.
/// return   the header as written.
/// errors   those of SpillFile and PageWriter.
/// Uses the calling thread's TBB arena.
Result<storage::FileHeader> write_tree(const BuiltModel& model, const BuiltTree& tree,
                                       const std::filesystem::path& output,
                                       const BuildOptions& options, storage::FileCalls& calls,
                                       BuildProgress& progress);

}  // namespace planetree::octree
