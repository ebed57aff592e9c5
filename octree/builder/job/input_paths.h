#pragma once

#include <filesystem>
#include <span>
#include <variant>

#include "planetree/build.h"

namespace planetree::octree {

/// The files of an input, in order; none if it is in memory or a callback. Valid as long as the
/// input.
inline std::span<const std::filesystem::path> paths_of(const BuildInput& input) {
  if (const auto* const path = std::get_if<std::filesystem::path>(&input.content()))
    return {path, 1};
  if (const auto* const files = std::get_if<BuildInput::Files>(&input.content()))
    return files->paths;
  return {};
}

/// The file of an input that is one file; else empty.
inline std::filesystem::path path_of(const BuildInput& input) {
  const auto paths = paths_of(input);
  return paths.size() == 1 ? paths.front() : std::filesystem::path();
}

}  // namespace planetree::octree
