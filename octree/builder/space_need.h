#pragma once

#include <cstdint>
#include <filesystem>

#include "octree/builder/job/build_memory.h"
#include "octree/builder/job/build_progress.h"
#include "octree/builder/mesh/mesh_size.h"
#include "planetree/error.h"
#include "storage/system/file_calls.h"

namespace planetree::octree {

/// How much a build is going to write, foreseen: at least what it writes. Of temporary files it
/// is about a seventh more, and where memory holds a part two chunks more; of the file two to
/// four times as much, for how far it can be compressed is not known before.
///
/// More is written of what no surface is: triangles that share few edges though they share
/// vertices, or most of which reach through much of the model.
struct SpaceNeed {
  std::uint64_t temporary_bytes = 0;  ///< put away on disk, together
  std::uint64_t output_bytes = 0;     ///< of the file

  /// Of a mesh whose faces are in some order, as nearly all are.
  ///
  /// cut  only what touches a region is built: what that takes is not foreseen until it is cut
  ///      out.
  static SpaceNeed before_reading(const MeshSize& size, const BuildMemory& memory,
                                  bool cut = false);
  /// The same of one whose corners have to be sorted, which is known once it is met.
  ///
  /// written_bytes  of temporary files are there.
  static SpaceNeed before_sorting(const MeshSize& size, const BuildMemory& memory,
                                  std::uint64_t written_bytes, bool cut = false);
  /// What is still to come once the triangles are known and put away.
  ///
  /// kept_bytes  of it are there, from an earlier build,
  /// matched     which did not leave edges to be matched.
  static SpaceNeed after_reading(const MeshSize& size, const BuildMemory& memory,
                                 std::uint64_t kept_bytes = 0, bool matched = false,
                                 bool cut = false);
  /// What building the triangles that touch a region takes.
  static SpaceNeed after_cutting(const MeshSize& part, const BuildMemory& memory,
                                 std::uint64_t kept_bytes);

  /// Holds it against the free space of both directories, or of the device they share.
  ///
  /// place   set if there is too little: which of the two to do something about.
  /// errors  kNoSpace: says how much is needed, how much there is and what to do. A device that
  ///         does not tell its free space is taken for large enough.
  Result<void> check(const std::filesystem::path& temporary_directory,
                     const std::filesystem::path& output_directory, storage::FileCalls& calls,
                     BuildDirectory& directory) const;
};

}  // namespace planetree::octree
