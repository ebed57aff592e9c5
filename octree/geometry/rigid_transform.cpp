#include "octree/geometry/rigid_transform.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/strict_math.h"

namespace planetree::octree {

std::optional<RigidTransform> RigidTransform::of(const Pose& pose) {
  const auto& [w, x, y, z] = pose.rotation;
  const Vec3& t = pose.translation;
  const double length2 = w * w + x * x + y * y + z * z;
  const double off_unit = std::fabs(length2 - 1);
  const double greatest = std::max({std::fabs(t.x), std::fabs(t.y), std::fabs(t.z)});
  const bool has_nan = std::isnan(t.x) || std::isnan(t.y) || std::isnan(t.z);
  if (!(off_unit <= Pose::kMaxLengthError) || has_nan || !(greatest <= kMaxCoordinate)) return {};

  const double s = 2 / length2;
  RigidTransform transform;
  transform.row_x_ = {1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)};
  transform.row_y_ = {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)};
  transform.row_z_ = {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)};
  transform.translation_ = t;
  transform.rotation_error_ = kRotationRounding + 2 * off_unit;
  // The length of t is at most twice its greatest coordinate.
  transform.translation_error_ = 2 * kTranslationRounding * greatest;
  transform.is_identity_ = length2 == 1 && x == 0 && y == 0 && z == 0 && greatest == 0;
  return transform;
}

}  // namespace planetree::octree
