#include "query/answer/open_side.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/winding/star_share.h"

namespace planetree::query {
namespace {

using octree::Point;
using octree::WindingGoal;
using octree::WindingNumber;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr SideResult kUnknownSide{Side::kUnknown, Status::kDegraded};

// Rounds to the nearest whole number; clamps to +-2^62.
std::int64_t rounded(double value) {
  constexpr double kMaxWindingNumber = 0x1p62;  // fits std::int64_t
  return static_cast<std::int64_t>(
      std::clamp(value + (value < 0 ? -0.5 : 0.5), -kMaxWindingNumber, kMaxWindingNumber));
}

// Whether the share of the caps is below one half because they are far away or small.
bool caps_cannot_matter(const ModelGeometry& model, const Point& point) {
  if (model.cap_grid.is_clear(point)) return true;
  if (!(point.cwiseAbs().maxCoeff() <= octree::kMaxQueryCoordinate)) return true;
  const Point gap = (model.tree.box_lower - point).cwiseMax(point - model.tree.box_upper);
  // 4 pi times 0.48.
  constexpr double kLargeAngle = 6;
  return model.cap_area < kLargeAngle * gap.cwiseMax(0.0).squaredNorm();
}

}  // namespace

SideResult OpenSide::run(const SideResult& result) {
  // A point on the surface is on it whatever the caps are.
  if (result.side != Side::kInside && result.side != Side::kOutside) return result;
  if (caps_cannot_matter(model_, point_)) {
    if (reason_) reason_->caps_cannot_matter = true;
    return result;
  }
  SideResult closed = result;
  const bool is_exact = !search_ || search_->has_exact_winding();
  const double known = is_exact ? static_cast<double>(closed.winding) : 0;
  WindingNumber w = less_caps({known, 0}, WindingGoal::kHalf);
  // If only the sign is known, a share of the caps below one half suffices.
  if (!is_exact && !w.on_surface && w.below_half()) return closed;
  if (!is_exact) {
    closed = search_->count_exactly(limit_.left());
    if (closed.side == Side::kUnknown) return closed;
    if (!w.on_surface) w = less_caps({static_cast<double>(closed.winding), 0}, WindingGoal::kHalf);
  }
  // On a cap the sum leaves out the caps that the point is on.
  if (w.on_surface) w = beside_triangles(closed.winding, WindingGoal::kHalf);
  return result_of(w, static_cast<double>(closed.winding));
}

// The winding number of the surface and its caps without the triangles and caps at the point, and
// less the share of the other caps. `closed` is that of the point after its infinitesimal step.
WindingNumber OpenSide::beside_triangles(std::int64_t closed, WindingGoal goal) {
  const octree::StarShare star =
      octree::star_share(model_.tree, point_, limit_.left(), pages_, work_);
  if (!star.complete) return {0, kInfinity, false, false};
  const octree::WindingBase base{static_cast<double>(closed) - star.value,
                                 star.error + octree::kStarRounding * (1 + std::fabs(star.value))};
  return less_caps(base, goal);
}

SideResult OpenSide::sign_on_surface(const SideResult& on_surface) {
  const WindingNumber w = beside_triangles(on_surface.winding, WindingGoal::kSign);
  const int sign = w.sign_is_certain() ? (w.value < 0 ? -1 : 1) : 0;
  return {Side::kOnSurface, Status::kExact, sign, false, w.complete};
}

SideResult OpenSide::result_of(const WindingNumber& w, double closed) const {
  if (reason_) {
    reason_->rule = SideReason::Rule::kWindingNumber;
    reason_->closed = closed;
    reason_->value = w.value;
    reason_->error = w.error;
  }
  if (w.above_half()) return {Side::kInside, Status::kExact, rounded(w.value)};
  if (w.below_half()) return {Side::kOutside, Status::kExact};
  return kUnknownSide;
}

// The winding number of the surface: `base` less the share of the caps.
WindingNumber OpenSide::less_caps(const octree::WindingBase& base, WindingGoal goal) {
  if (!model_.tree.caps) return {base.value, base.error};
  WindingNumber w = octree::winding_number(model_.caps, point_, limit_.left(), pages_, work_,
                                           {-base.value, base.error}, goal);
  w.value = -w.value;
  return w;
}

}  // namespace planetree::query
