#pragma once

#include <cstdint>
#include <filesystem>

#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/packing.h"
#include "planetree/error.h"

namespace planetree::octree {

enum class MeshFormat : std::uint8_t { kPly, kStlBinary, kStlAscii, kOff, kObj, kGltf, kUnknown };

/// Finds how a mesh file is compressed: by its content, unless that is a whole binary STL.
/// errors  those of MeshFile::read().
Result<Packing> detect_packing(const MeshFile& file);

/// The path without the extension that a compressed file has, .gz or .zst.
std::filesystem::path unpacked_path(const std::filesystem::path& path);

/// Finds the format of a mesh file that is not compressed by its content or, where that does not
/// tell it, by the extension of its path.
/// errors  those of MeshFile::read(); kBadInput: the file is of a format that no reader reads,
/// which
///         the text names.
Result<MeshFormat> detect_format(const MeshFile& file, const std::filesystem::path& path);

}  // namespace planetree::octree
