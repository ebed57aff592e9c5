#include "tools/view/shape_place.h"

#include <algorithm>
#include <cmath>

#include "query/file/scale.h"

namespace planetree::tools {

ShapeFrame ShapeFrame::of(const storage::FileHeader& header) {
  const query::Scale scale(header.model.scale_exponent);
  const double* const centre = header.model.centre;
  return {scale.out(octree::Point{centre[0], centre[1], centre[2]}), scale.out(1.0)};
}

ShapeFrame ShapeFrame::about(const Vec3& lower, const Vec3& upper) {
  const auto middle = [](double a, double b) { return 0.5 * a + 0.5 * b; };
  const double longest = std::clamp(
      std::max({upper.x - lower.x, upper.y - lower.y, upper.z - lower.z}), 0x1p-1000, 0x1p1000);
  return {{middle(lower.x, upper.x), middle(lower.y, upper.y), middle(lower.z, upper.z)},
          std::ldexp(1.0, std::ilogb(longest))};
}

ShapePlace::ShapePlace(const Pose& pose, const ShapeFrame& own, const ShapeFrame& all)
    : scale_(own.unit / all.unit), rotation_(pose.rotation) {
  const Vec3 centre = octree::RigidTransform::of(pose)->apply(own.centre);
  const Vec3 offset{(centre.x - all.centre.x) / all.unit, (centre.y - all.centre.y) / all.unit,
                    (centre.z - all.centre.z) / all.unit};
  turn_ = octree::RigidTransform::of({pose.rotation, offset}).value_or(turn_);
}

ShapeView ShapePlace::view_from(const ShapeView& view) const {
  ShapeView own = view;
  const Vec3 eye = turn_.apply_inverse(view.eye);
  own.eye = {eye.x / scale_, eye.y / scale_, eye.z / scale_};
  own.look = turn_.rotate_inverse(view.look);
  return own;
}

}  // namespace planetree::tools
