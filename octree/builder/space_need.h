#pragma once

#include <cstdint>
#include <filesystem>

#include "octree/builder/job/build_memory.h"
#include "octree/builder/job/build_progress.h"
#include "octree/builder/mesh/mesh_size.h"
#include "planetree/error.h"
#include "storage/system/file_calls.h"

namespace planetree::octree {

/// Estimate of what a build is going to write: at least what it writes. Temporary files are
/// overestimated by about a seventh and, where memory holds a part, by two batches. The output is
/// overestimated by a factor of two to four, since its compression is not known before.
///
/// More than the estimate is written for triangles that do not form a surface: triangles that share
/// few edges though they share vertices, or that mostly reach through much of the model.
struct SpaceNeed {
  std::uint64_t temporary_bytes = 0;  ///< all temporary files together
  std::uint64_t output_bytes = 0;     ///< the output file

  /// For a mesh whose faces are in some order, as nearly all are.
  ///
  /// cut  only triangles that touch a region are built; what these take is not foreseen until they
  ///      are cut out.
  static SpaceNeed before_reading(const MeshSize& size, const BuildMemory& memory,
                                  bool cut = false);
  /// For a mesh whose corners have to be sorted, which is found out while it is read.
  ///
  /// written_bytes  bytes of temporary files that exist already.
  static SpaceNeed before_sorting(const MeshSize& size, const BuildMemory& memory,
                                  std::uint64_t written_bytes, bool cut = false);
  /// What is still to be written once the triangles are read.
  ///
  /// kept_bytes  bytes of it that exist already, from an earlier build,
  /// matched     which has matched the edges.
  static SpaceNeed after_reading(const MeshSize& size, const BuildMemory& memory,
                                 std::uint64_t kept_bytes = 0, bool matched = false,
                                 bool cut = false);
  /// What building the triangles that touch a region takes.
  static SpaceNeed after_cutting(const MeshSize& part, const BuildMemory& memory,
                                 std::uint64_t kept_bytes);

  /// Estimate of the pages of a mesh as they are spilled.
  static std::uint64_t raw_page_bytes(const MeshSize& size);

  /// Compares the estimate with the free space of both directories, or of the device they share.
  ///
  /// directory  set if there is too little space: the one to do something about.
  /// errors     kNoSpace: the text says how much is needed, how much is free and what to do. A
  ///            device that does not report its free space counts as large enough.
  Result<void> check(const std::filesystem::path& temporary_directory,
                     const std::filesystem::path& output_directory, storage::FileCalls& calls,
                     BuildDirectory& directory) const;
};

}  // namespace planetree::octree
