#pragma once

#include <cstdint>
#include <filesystem>

#include "octree/builder/mesh/mesh_reader.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "planetree/build.h"
#include "planetree/error.h"
#include "storage/system/file_calls.h"

namespace planetree::octree {

/// Size of a mesh, estimated before it is read.
struct MeshSize {
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;
  bool float64 = false;          ///< coordinates may need float64, by format and header
  bool is_indexed_text = false;  ///< a text whose vertices are spilled while it is read
  /// Length that a compressed file states for its content, at least its own. The other members are
  /// 0 then: they are estimated after the content is unpacked. Of a glTF, the length of the buffers
  /// that are embedded in it. 0 for other files.
  std::uint64_t unpacked_bytes = 0;
  std::uint32_t attributes = 0;  ///< that the file is to keep; estimate() does not set it

  /// Adds the size of a mesh that is read after this one, and whose content is unpacked after that
  /// of this one is removed.
  void add(const MeshSize& next);

  /// Estimates the size of a file from its header and its length, or from samples of a text that
  /// declares nothing. A mesh in memory and a callback say their size.
  ///
  /// return  at least the true size, except for a text that is unlike its samples, an ascii PLY
  ///         with polygons of more than four corners, and a file that its reader will refuse. An
  ///         STL does not state its vertices: half as many as triangles are assumed, as a closed
  ///         surface has, unless triangles have no corners in common. A callback may say
  ///         nothing, which gives zero. Several files give the sum, but of `unpacked_bytes` the
  ///         maximum, since only one at a time is unpacked.
  /// errors  those of opening the file and reading it. If the input is several files, `failed_at`
  ///         is set to the one that the error concerns, unless it is null.
  static Result<MeshSize> estimate(const BuildInput& input,
                                   storage::FileCalls& calls = storage::FileCalls::real(),
                                   const MeshOptions& options = {},
                                   std::filesystem::path* failed_at = nullptr);
  /// Estimates the size of a file that is open and not compressed.
  ///
  /// path  decides the format if the content does not.
  static Result<MeshSize> estimate(const MeshFile& file, const std::filesystem::path& path,
                                   const MeshOptions& options = {});
};

}  // namespace planetree::octree
