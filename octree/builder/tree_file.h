#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "octree/builder/attributes/attribute_pages.h"
#include "octree/builder/cap_tree.h"
#include "octree/builder/field/built_field.h"
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

/// A model whose parts are all built.
struct BuiltModel {
  ModelFrame frame;
  std::uint64_t vertex_records = 0;
  BlockShape shape;
  EdgeBalance edges;    ///< edges of the whole input, as the frame is
  double openness = 0;  ///< openness of the whole input, see AreaSums
  SurfaceCut cut;
  std::optional<RegionBox> box;
  ChunkTree above;
  std::vector<BuiltChunk> chunks;  ///< in the order of above.chunks
  std::optional<BuiltMask> mask;   ///< only if triangles are in the region
  BuiltField field;
  KeptAttributes attributes;
};

/// Joins the parts and writes the file, completely or not at all.
///
/// tree     the tree of the model's chunks, and `caps` that of its caps.
/// calls    the system.
/// scratch  for temporary data.
/// return   the header as written.
/// errors   those of SpillFile and PageWriter; kBadArgument: too many pages for a file.
/// Uses the calling thread's TBB arena.
Result<storage::FileHeader> write_tree(const BuiltModel& model, const BuiltTree& tree,
                                       const CapTree& caps, const std::filesystem::path& output,
                                       const BuildOptions& options, storage::FileCalls& calls,
                                       storage::SpillFile& scratch, BuildProgress& progress);

}  // namespace planetree::octree
