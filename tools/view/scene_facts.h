#pragma once

#include <string>

#include "tools/scene/opened_scene.h"
#include "tools/view/scene_layout.h"

/// What a scene tells the page, as JSON.
namespace planetree::tools {

/// name  of the scene file, without its folder
std::string scene_info_json(const std::string& name, const SceneDescription& description,
                            const OpenedScene& opened, const SceneLayout& layout);

std::string scene_stats_json(const SceneStats& stats);

}  // namespace planetree::tools
