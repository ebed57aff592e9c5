#pragma once

#include "octree/geometry/triangle_distance.h"
#include "octree/page/frame.h"
#include "tools/check/geometry_check.h"

namespace planetree::tools {

/// Whether the moments stated for a block are those of its triangles.
///
/// centre  the model's centre, model frame
bool moments_fit(const Bounds& stated, const octree::BlockView& block, const octree::Point& centre);

/// Whether the moments stated for a node fit those that the node states for its children.
bool moments_fit(const Bounds& stated, const octree::Node& node);

}  // namespace planetree::tools
