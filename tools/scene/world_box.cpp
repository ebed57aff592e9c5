#include "tools/scene/world_box.h"

#include <algorithm>
#include <array>

#include "octree/geometry/rigid_transform.h"

namespace planetree::tools {

WorldBox moved_box(const Pose& pose, const WorldBox& box) {
  const auto transform = octree::RigidTransform::of(pose);
  std::array<WorldBox, 8> corners;
  for (unsigned corner = 0; corner < corners.size(); ++corner) {
    const Vec3 at = transform->apply({(corner & 1U) != 0 ? box.upper.x : box.lower.x,
                                      (corner & 2U) != 0 ? box.upper.y : box.lower.y,
                                      (corner & 4U) != 0 ? box.upper.z : box.lower.z});
    corners[corner] = {at, at};
  }
  return box_around(corners);
}

WorldBox box_around(std::span<const WorldBox> boxes) {
  WorldBox whole = boxes.front();
  for (const WorldBox& box : boxes) {
    whole.lower = {std::min(whole.lower.x, box.lower.x), std::min(whole.lower.y, box.lower.y),
                   std::min(whole.lower.z, box.lower.z)};
    whole.upper = {std::max(whole.upper.x, box.upper.x), std::max(whole.upper.y, box.upper.y),
                   std::max(whole.upper.z, box.upper.z)};
  }
  return whole;
}

}  // namespace planetree::tools
