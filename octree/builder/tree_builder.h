#pragma once

#include <filesystem>
#include <string>

#include "octree/builder/build_seams.h"
#include "octree/builder/job/build_options.h"
#include "octree/builder/job/build_progress.h"
#include "planetree/error.h"
#include "storage/file/file_layout.h"

/// From a mesh file to a .ptree file.
namespace planetree::octree {

struct BuildReport {
  storage::FileHeader header;         ///< as written
  std::uint64_t input_triangles = 0;  ///< that could be used, built or not
  std::string first_skipped;          ///< the first bad record in words; empty if none
  std::uint64_t temporary_bytes = 0;  ///< spilled on disk
};

/// Reads the mesh at `input` and writes its tree to `output`, whole or not at
/// all. The bytes written depend on the mesh, box and page_bytes alone.
///
/// box     with options.box the file holds the triangles that touch it, by a test that may take
///         some that just do not; frame, edges and winding numbers are those of all.
/// memory  options.memory_bytes at most, but where more than 2^18 triangles are at one place.
/// resume  with options.resume, phases and patches that are completed are kept in
///         options.work_directory(), and gone on with where a build of the same input and
///         options was interrupted or failed; the bytes written are the same. The directory is
///         removed once the output is there, whole; if that fails, the output stays.
/// disk    about 120 bytes a triangle in temp_directory where memory is short; 200 with float64
///         coordinates, and 250 more of triangles that share no edges. While a mesh is read whose
///         faces are in no order, and whose vertices do not fit in memory, 90 more or 120; and
///         vertices of a text, 12 or 24 bytes each. Given back however the
///         process ends, but for what of it a build that can be resumed keeps, memory or not:
///         about 80 bytes a triangle, or 130.
/// errors  those of read_mesh, storage::SpillFile, storage::PageWriter and Checkpoint; kBadArgument
///         for page_bytes, a box that is none or one that no triangle touches; kNoMemory for too
///         little memory_bytes; kBadInput for a bad record under `strict`; kNoSpace where SpaceNeed
///         foresees too little, before anything is written, where corners turn out to have to be
///         sorted, or once the triangles are read.
/// source  bottom-up construction from candidate planes: "Out-of-core real-time
///         haptic interaction on very large models", section 3.1; blocks,
///         collapse and paging are ours.
Result<BuildReport> build_tree(const std::filesystem::path& input,
                               const std::filesystem::path& output, const BuildOptions& options,
                               BuildProgress& progress, const BuildSeams& seams = {});

}  // namespace planetree::octree
