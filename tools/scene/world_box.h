#pragma once

#include <span>

#include "planetree/pose.h"
#include "planetree/types.h"

namespace planetree::tools {

/// A box in the world's coordinates.
struct WorldBox {
  Vec3 lower, upper;
};

/// The box around a box that a pose has moved.
///
/// pose  valid
WorldBox moved_box(const Pose& pose, const WorldBox& box);

/// The box around boxes, of which there is at least one.
WorldBox box_around(std::span<const WorldBox> boxes);

}  // namespace planetree::tools
