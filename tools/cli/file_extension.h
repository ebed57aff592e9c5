#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

namespace planetree::tools {

/// The extension of a file's name with its dot, in small letters: ".ply" of "scan.PLY". Empty if
/// there is none.
[[nodiscard]] inline std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c; });
  return extension;
}

}  // namespace planetree::tools
