#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/scene/opened_scene.h"

namespace planetree::tools {

/// A layer that a model leaves out.
struct LayerLeftOut {
  std::string name;
  std::uint64_t pages = 0;  ///< of the file, that are never read
  std::uint64_t bytes = 0;  ///< of these pages in the file
};

/// What one model of a scene takes.
struct ModelShare {
  const ModelDescription* model = nullptr;
  std::uint64_t triangles = 0;
  std::uint64_t instances = 0;
  ModelMemory memory;                  ///< besides its pages
  std::vector<LayerLeftOut> left_out;  ///< layers of the file that are not open
  std::uint64_t saved_bytes = 0;       ///< of memory besides pages, by the layers left out
};

/// Measures what the models of a scene take, in the order of the file. Models without an instance
/// have no share. To measure what leaving layers out saves, the models are opened once more, with
/// all layers, in a scene of the same budget.
///
/// failure  receives what went wrong if false is returned
bool measure_shares(const SceneDescription& description, const OpenedScene& opened,
                    std::vector<ModelShare>& shares, SceneFailure& failure);

/// What a model takes besides its pages, in bytes by layer.
nlohmann::ordered_json memory_json(const ModelMemory& memory);

/// The report of a scene as text and as JSON.
///
/// file  the name of the scene file
std::string scene_text(const std::string& file, const SceneDescription& description,
                       const OpenedScene& opened, const std::vector<ModelShare>& shares);
nlohmann::ordered_json scene_json(const std::string& file, const SceneDescription& description,
                                  const OpenedScene& opened, const std::vector<ModelShare>& shares);

}  // namespace planetree::tools
