#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "octree/builder/sort/ordered_mesh.h"
#include "octree/builder/sort/triangle_runs.h"
#include "octree/builder/tree/chunk_build.h"
#include "octree/geometry/area_sums.h"
#include "storage/spill/result_file.h"
#include "storage/spill/spill_file.h"
#include "storage/spill/spill_runs.h"

/// Results of the steps of a build that several processes share. Offsets count from the start of
/// the data of the file that a result is in.
namespace planetree::octree {

using ResultFilePointer = std::shared_ptr<const storage::ResultFile>;

/// The mesh as a whole, without its triangles.
struct PlannedMesh {
  ResultFilePointer file;  ///< has the attributes
  OrderedMesh mesh;
};

/// A part of the triangles, in sorted runs.
struct SortedPart {
  ResultFilePointer file;
  std::vector<TriangleRuns::Extent> runs;
};

/// What is known of a stretch of chunks.
struct ChunkResults {
  std::vector<BuiltChunk> chunks;
  std::vector<storage::SpillRuns::Extent> edges;  ///< left over by the chunks, see EdgeCensus
  AreaSums::Words areas{};                        ///< of their triangles
  std::int64_t winding = 0;                       ///< what these count, see RegionCut
};
struct BuiltPart {
  ResultFilePointer file;
  ChunkResults results;
};

/// All of a build but what needs the surface as a whole.
struct ShardResults {
  PlannedMesh plan;
  std::vector<SortedPart> sorted;
  std::vector<BuiltPart> built;  ///< in the order of their chunks
};

/// Attaches the files of sorted parts to `file`, and their runs to `runs`, which reads from it.
void attach_runs(std::span<const SortedPart> parts, storage::SpillFile& file, TriangleRuns& runs);

/// Attaches the file of a result to `file`. Returns the chunks with offsets there.
std::vector<BuiltChunk> attach_chunks(const BuiltPart& part, storage::SpillFile& file);

/// Extents that are moved by `offset`.
std::vector<storage::SpillRuns::Extent> moved(std::vector<storage::SpillRuns::Extent> extents,
                                              std::uint64_t offset);

}  // namespace planetree::octree
