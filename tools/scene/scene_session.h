#pragma once

#include <optional>
#include <span>
#include <vector>

#include "planetree/types.h"
#include "tools/scene/opened_scene.h"
#include "tools/scene/scene_description.h"
#include "tools/session/touch_arguments.h"
#include "tools/session/touch_outcome.h"

/// The session of `planetree touch --scene`: that of `tools/session/`, in a scene that moves by the
/// velocities of the scene file. Its memory is that of the arguments.
namespace planetree::tools {

/// Finds the tip's path, which follows the surfaces while they move, in the world's coordinates.
/// The scene is opened for it alone, so that the path leaves no page in the session's memory.
///
/// failure  receives what went wrong if nothing is returned
std::optional<std::vector<Vec3>> find_scene_path(const TouchArguments& arguments,
                                                 const SceneDescription& description,
                                                 SceneFailure& failure);

/// Runs the session in real time. Each tick puts the instances that move where they are then.
/// Sides are asked if each model tells them.
///
/// failure  receives what went wrong if nothing is returned
std::optional<TouchOutcome> run_scene_session(const TouchArguments& arguments,
                                              const SceneDescription& description,
                                              std::span<const Vec3> path, SceneFailure& failure);

}  // namespace planetree::tools
