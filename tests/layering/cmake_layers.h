#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>

namespace planetree::layering {

/// A folder as CMake knows it.
struct CMakeLayer {
  std::string name;               ///< of the target
  std::set<std::string> depends;  ///< targets of this project that it names in DEPENDS
};

/// What the planetree_add_layer() calls in the CMakeLists.txt files below `root` say, by folder.
std::map<std::string, CMakeLayer> read_cmake_layers(const std::filesystem::path& root);

}  // namespace planetree::layering
