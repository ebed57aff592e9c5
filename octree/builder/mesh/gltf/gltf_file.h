#pragma once

#include <cstdint>
#include <string_view>

#include "octree/builder/mesh/stream/mesh_file.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Bytes [begin, end) of a mesh file.
struct FileRange {
  std::uint64_t begin = 0, end = 0;

  [[nodiscard]] std::uint64_t bytes() const { return end - begin; }
};

/// Where the parts of a glTF file are.
struct GltfParts {
  FileRange json;
  FileRange binary;           ///< the BIN chunk of a GLB; empty if there is none
  bool has_binary = false;    ///< whether there is one
  std::uint64_t surplus = 0;  ///< bytes behind the end of a GLB
};

/// Whether a file is a GLB, the binary form of glTF.
/// file  front of the file.
bool is_glb(std::string_view file) noexcept;

/// Whether a file is a JSON object, and has a word of every glTF or is named as one.
/// file  front of the file.
bool is_gltf_json(std::string_view file, bool is_named_gltf) noexcept;

/// Finds the parts of a glTF file. A file that is no GLB is JSON as a whole.
///
/// errors  those of reading the file; kBadInput: the header or the chunks of a GLB are damaged, or
///         it is of another version than 2.
Result<GltfParts> find_gltf_parts(const MeshFile& file);

}  // namespace planetree::octree
