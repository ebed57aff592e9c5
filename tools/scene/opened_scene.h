#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "planetree/scene.h"
#include "tools/scene/scene_description.h"

namespace planetree::tools {

/// What went wrong, and with which file.
struct SceneFailure {
  std::filesystem::path file;
  Error error;
};

/// A scene that a scene file describes. The instances are in the order of the file.
struct OpenedScene {
  Scene scene;
  std::vector<InstanceId> ids;  ///< ascending, since later instances have greater ones

  /// Opens all models and places all instances.
  ///
  /// wanted   options that the description does not decide, see options_for()
  /// failure  receives what went wrong if nothing is returned
  static std::optional<OpenedScene> open(const SceneDescription& description,
                                         const std::filesystem::path& file,
                                         const SceneOptions& wanted, SceneFailure& failure);
  /// The position of an instance in the file; ids.size() if it has none.
  std::size_t index_of(InstanceId id) const;
};

/// Returns the options of a scene whose frames hold the pages of all models, for one probe. The
/// others are those of `wanted`.
Result<SceneOptions> options_for(const SceneDescription& description, const SceneOptions& wanted,
                                 std::filesystem::path& failed_file);

/// The parts of answers that the model of an instance tells. If it does not tell sides, an answer
/// with a side is degraded even if all pages are in memory.
///
/// index  of the instance in the file
std::uint32_t parts_told_by(const SceneDescription& description, const OpenedScene& opened,
                            std::size_t index);

/// The error to report after the answers if pages were unreadable, so that answers are degraded.
/// Empty if there were none.
std::optional<Error> scene_pages_lost(std::uint64_t quarantined_pages);

}  // namespace planetree::tools
