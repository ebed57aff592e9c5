#include "octree/builder/job/region_box.h"

#include <cmath>
#include <utility>

#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

Point point_of(const Vec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

Result<void> RegionBox::check() const {
  for (const auto& [from, to] :
       {std::pair(lower.x, upper.x), std::pair(lower.y, upper.y), std::pair(lower.z, upper.z)})
    if (!std::isfinite(from) || !std::isfinite(to) || from > to)
      return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                        "a box from %g to %g; give finite corners, the lower first", from, to);
  return {};
}

Result<void> RegionBox::check_meets(const ModelFrame& frame) const {
  if ((point_of(lower).array() <= frame.input_upper.array()).all() &&
      (point_of(upper).array() >= frame.input_lower.array()).all())
    return {};
  return no_triangle_touches(frame);
}

Region RegionBox::region(const ModelFrame& frame) const {
  return {frame.scaled(point_of(lower)), frame.scaled(point_of(upper)), frame.lower(),
          frame.upper()};
}

Error no_triangle_touches(const ModelFrame& frame) {
  const Point &lower = frame.input_lower, &upper = frame.input_upper;
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "no triangle touches the box; that of the whole model is "
                    "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g",
                    lower.x(), lower.y(), lower.z(), upper.x(), upper.y(), upper.z());
}

}  // namespace planetree::octree
