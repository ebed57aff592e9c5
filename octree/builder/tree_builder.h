#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "octree/builder/build_seams.h"
#include "octree/builder/job/build_options.h"
#include "octree/builder/job/build_progress.h"
#include "octree/builder/job/model_frame.h"
#include "octree/builder/shard_results.h"
#include "planetree/build.h"
#include "planetree/error.h"
#include "storage/file/file_layout.h"

/// Builds a .ptree file.
namespace planetree::octree {

struct BuildReport {
  storage::FileHeader header;         ///< as written
  ModelFrame frame;                   ///< what reading the whole input found
  std::uint64_t temporary_bytes = 0;  ///< bytes that were spilled to disk
  std::vector<std::string> notes;     ///< as MeshSummary::notes
  Metadata metadata;                  ///< as written
};

/// Reads a mesh and writes its tree to `output`, completely or not at all. The bytes
/// written depend on the mesh, box, page_bytes, layers and float64 alone.
///
/// box     with options.box the file holds the triangles that touch the box, and possibly some that
///         just miss it. Frame, edges and winding numbers are those of the whole input.
/// memory  at most options.memory_bytes, except where more than 2^18 triangles are at one position.
/// resume  with options.resume, completed phases and chunks are kept in options.work_directory(). A
///         build of the same input and options resumes where an earlier one was interrupted or
///         failed; the bytes written are the same. The directory is removed once the output is
///         complete. If that fails, the output stays.
/// disk    about 120 bytes a triangle in temp_directory where memory is short; 200 with float64
///         coordinates; 250 more for triangles that share no edges. While a mesh is read whose
///         faces are in no order and whose vertices do not fit in memory, 90 more, or 120 with
///         float64; for vertices of a text, 12 or 24 bytes each. The content of a compressed mesh
///         takes its length. The space is given back however the process ends, except for what a
///         build that can be resumed keeps, whether memory is short or not: about 80 bytes a
///         triangle, or 130 with float64.
/// errors  those of read_mesh(), storage::SpillFile, storage::PageWriter and Checkpoint;
///         kBadArgument for page_bytes, for an invalid box, or for one that no triangle touches;
///         kNoMemory for too little memory_bytes; kBadInput for a bad record under `strict`;
///         those of `progress`; kNoSpace where SpaceNeed foresees too little space: before anything
///         is written, where corners turn out to have to be sorted, or once the triangles are read.
/// source  bottom-up construction from candidate planes: "Out-of-core real-time haptic interaction
///         on very large models", section 3.1; blocks, collapse and paging are ours.
Result<BuildReport> build_tree(const BuildInput& input, const std::filesystem::path& output,
                               const BuildOptions& options, BuildProgress& progress,
                               const BuildSeams& seams = {});

/// Writes the tree of a mesh of which other processes have sorted the triangles and built the
/// chunks: the bytes that build_tree() writes. Joins edges, makes caps, mask and field.
///
/// results  of steps that were given the same input, options and seams; without a region.
/// input    as for build_tree(); only its path is used.
/// options  as for build_tree(), without `resume`.
/// errors   as those of build_tree(), but for the input; also kDamaged for results.
Result<BuildReport> merge_tree(const ShardResults& results, const BuildInput& input,
                               const std::filesystem::path& output, const BuildOptions& options,
                               BuildProgress& progress, const BuildSeams& seams = {});

}  // namespace planetree::octree
