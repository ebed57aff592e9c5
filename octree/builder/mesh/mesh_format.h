#pragma once

#include <cstdint>
#include <filesystem>

#include "octree/builder/mesh/stream/mesh_file.h"
#include "planetree/error.h"

namespace planetree::octree {

enum class MeshFormat : std::uint8_t { kPly, kStlBinary, kStlAscii, kOff, kObj, kUnknown };

/// Finds the format of a mesh file by its content or, where that does not tell it, by the extension
/// of its path.
/// errors  those of MeshFile::read(); kBadInput: the file is of a format that no reader reads,
/// which
///         the text names.
Result<MeshFormat> detect_format(const MeshFile& file, const std::filesystem::path& path);

}  // namespace planetree::octree
