#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planetree/error.h"
#include "planetree/layers.h"
#include "planetree/pose.h"
#include "planetree/scene.h"

namespace planetree::tools {

/// A model that a scene file names.
struct ModelDescription {
  std::string name;
  std::filesystem::path file;  ///< relative to the current folder, or absolute
  std::uint32_t layers = kAllLayers;
};

/// A place of a model that a scene file names.
struct InstanceDescription {
  std::string name;       ///< may be empty
  std::size_t model = 0;  ///< index in SceneDescription::models
  Pose pose;
  Twist twist;
};

/// The content of a scene file: format-spec/scene-v1/spec.md.
struct SceneDescription {
  std::optional<std::uint64_t> memory_bytes;
  std::vector<ModelDescription> models;        ///< at least one, in the order of the file
  std::vector<InstanceDescription> instances;  ///< at least one

  /// The memory budget that a command uses: what its user wants, or what the file says, or 256 MiB.
  std::uint64_t budget_bytes(std::optional<std::uint64_t> wanted) const {
    return wanted.value_or(memory_bytes.value_or(SceneOptions().memory_budget_bytes));
  }
};

/// Reads the text of a scene file.
///
/// folder  that the paths of models are relative to
/// errors  kBadInput: what is wrong, and where
Result<SceneDescription> parse_scene(std::string_view text, const std::filesystem::path& folder);

/// Reads a scene file.
///
/// errors  those of parse_scene(); kNotFound, kPermission, kReadFailed
Result<SceneDescription> read_scene(const std::filesystem::path& file);

}  // namespace planetree::tools
