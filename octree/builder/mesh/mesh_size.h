#pragma once

#include <cstdint>
#include <filesystem>

#include "planetree/error.h"
#include "storage/system/file_calls.h"

namespace planetree::octree {

/// How large a mesh is, as far as can be told before it is read.
struct MeshSize {
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;
  bool float64 = false;          ///< unless the format declares coordinates that float32 holds
  bool is_indexed_text = false;  ///< its vertices are put away while it is read

  /// Looks at a header and the file's size, or at samples of a text that declares nothing.
  ///
  /// return  at least what is there, but in a text that is unlike its samples, an ascii PLY of
  ///         polygons of more than four corners, and a file that its reader will refuse. An STL
  ///         does not tell its vertices: half as many as triangles are assumed, what a closed
  ///         surface has, unless triangles have no corners in common.
  /// errors  those of opening the file and reading it.
  static Result<MeshSize> foresee(const std::filesystem::path& path,
                                  storage::FileCalls& calls = storage::FileCalls::real());
};

}  // namespace planetree::octree
