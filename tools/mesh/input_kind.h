#pragma once

#include <cstdint>
#include <filesystem>

#include "planetree/error.h"

namespace planetree::tools {

/// Whether a file is read as points or as a mesh.
enum class InputKind : std::uint8_t { kPoints, kMesh };

/// Tells the kind of a file that may be either by its content: a compressed file, an STL, an OBJ,
/// an OFF and a PLY with faces are meshes, all others are points, and so is standard input ("-").
///
/// errors  kNotFound, kPermission, kReadFailed; kBadInput: not a regular file
Result<InputKind> input_kind(const std::filesystem::path& path);

}  // namespace planetree::tools
