#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace planetree::octree {

enum class MeshFormat : std::uint8_t { kPly, kStlBinary, kStlAscii, kOff, kObj, kUnknown };

/// What a mesh file is, by its content, and only then by the extension of its path.
MeshFormat judge_format(std::string_view file, const std::filesystem::path& path);

}  // namespace planetree::octree
