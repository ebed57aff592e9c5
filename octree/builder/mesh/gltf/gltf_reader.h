#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/mesh/stream/triangle_sink.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Reads the triangles of a glTF 2.0, in JSON or binary form: those of the meshes that its scene
/// shows, where the nodes put them. Triangle lists, strips and fans are read; points, lines,
/// materials, skins, morph targets and animations are not. Positions are floats, or integers as
/// KHR_mesh_quantization has them; they are transformed in double precision. A primitive compressed
/// by Draco or meshoptimizer is refused. Contract as read_mesh().
///
/// path  of the file, to which the paths of other files with buffers are relative; empty if it is
///       the content of a compressed file.
/// keep  as MeshOptions::keep. Colours are those of COLOR_0, as shares of 255 without a change of
///       the colour space. Texture coordinates are those of TEXCOORD_0. A primitive without them is
///       white or has zeros, and is noted.
Result<MeshSummary> read_gltf(const MeshFile& file, const std::filesystem::path& path,
                              TriangleSink& sink, MeshScratch& scratch, std::uint32_t keep = 0);

/// What a glTF declares, in numbers.
struct GltfSize {
  std::uint64_t triangles = 0, vertices = 0;
  bool float64 = false;              ///< some positions are no floats
  std::uint64_t embedded_bytes = 0;  ///< of buffers in base64, once decoded
};

/// Sums up what the scene of a glTF declares. The buffers are not opened.
/// errors  those of reading the file; kBadInput.
Result<GltfSize> size_of_gltf(const MeshFile& file);

/// The other files that a glTF reads its buffers from, possibly missing.
/// errors  those of reading the file; kBadInput.
Result<std::vector<std::filesystem::path>> files_of_gltf(const MeshFile& file,
                                                         const std::filesystem::path& path);

}  // namespace planetree::octree
