#pragma once

#include <vector>

#include "tools/scene/opened_scene.h"
#include "tools/scene/world_box.h"
#include "tools/view/shape_reader.h"

namespace planetree::tools {

/// Where a scene is drawn.
struct SceneLayout {
  std::vector<FileParts> files;          ///< each file once
  std::vector<ShapeInstance> instances;  ///< in the order of the scene file
  std::vector<WorldBox> boxes;           ///< around the core of each instance
  WorldBox whole;                        ///< around all of these
  ShapeFrame frame;                      ///< that the instances are placed in

  /// Reads the headers of the files, and places the instances by their poses.
  ///
  /// failure  receives what went wrong if false is returned
  bool read(const SceneDescription& description, const OpenedScene& opened, SceneFailure& failure);
};

}  // namespace planetree::tools
