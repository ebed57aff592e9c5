#pragma once

#include <cstdint>
#include <filesystem>

#include "planetree/error.h"
#include "storage/system/file_calls.h"

namespace planetree::octree {

/// Size of a mesh, estimated before it is read.
struct MeshSize {
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;
  bool float64 = false;          ///< coordinates may need float64, by format and header
  bool is_indexed_text = false;  ///< a text whose vertices are spilled while it is read

  /// Estimates the size from the header and the length of the file, or from samples of a text that
  /// declares nothing.
  ///
  /// return  at least the true size, except for a text that is unlike its samples, an ascii PLY
  ///         with polygons of more than four corners, and a file that its reader will refuse. An
  ///         STL does not state its vertices: half as many as triangles are assumed, as a closed
  ///         surface has, unless triangles have no corners in common.
  /// errors  those of opening the file and reading it.
  static Result<MeshSize> estimate(const std::filesystem::path& path,
                                   storage::FileCalls& calls = storage::FileCalls::real());
};

}  // namespace planetree::octree
