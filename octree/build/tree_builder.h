#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "octree/build/build_progress.h"
#include "octree/build/build_seams.h"
#include "planetree/error.h"
#include "storage/file_layout.h"

/// From a mesh file to a .ptree file.
namespace planetree::octree {

struct BuildOptions {
  std::uint32_t page_bytes = 65536;  ///< of a decoded page; a power of two, 4 KiB to 256 KiB
  unsigned threads = 0;              ///< 0: as many as the machine has
  /// The most that the process should have resident, mapped pages included; 0: a quarter of
  /// the machine's memory. What does not fit is spilled.
  std::uint64_t memory_bytes = 0;
  std::filesystem::path temp_directory;  ///< for what is spilled; empty: the output's
  bool strict = false;                   ///< a set-aside record is an error
  bool replace = false;                  ///< an existing output may be replaced

  /// Where a build of this output spills.
  std::filesystem::path spill_directory(const std::filesystem::path& output) const;
};

struct BuildReport {
  storage::FileHeader header;         ///< as written
  std::string first_set_aside;        ///< the first bad record in words; empty if none
  std::uint64_t temporary_bytes = 0;  ///< spilled on disk
};

/// Reads the mesh at `input` and writes its tree to `output`, whole or not at
/// all. The bytes written depend on the mesh and page_bytes alone.
///
/// memory  options.memory_bytes at most, but where more than 2^18 triangles are at one place.
/// disk    about 120 bytes a triangle in temp_directory where memory is short; 200 with float64
///         coordinates, and 250 more of triangles that share no edges. Given back however the
///         process ends.
/// errors  those of read_mesh, storage::SpillFile and storage::PageWriter; kBadArgument for
///         page_bytes; kNoMemory for too little memory_bytes; kBadInput for a bad record
///         under `strict`; kNoSpace where SpaceNeed foresees too little, before anything is
///         written or once the triangles are read.
/// source  bottom-up construction from candidate planes: "Out-of-core real-time
///         haptic interaction on very large models", section 3.1; blocks,
///         collapse and paging are ours.
Result<BuildReport> build_tree(const std::filesystem::path& input,
                               const std::filesystem::path& output, const BuildOptions& options,
                               BuildProgress& progress, const BuildSeams& seams = {});

}  // namespace planetree::octree
