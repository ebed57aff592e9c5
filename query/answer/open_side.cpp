#include "query/answer/open_side.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/winding/star_share.h"

namespace planetree::query {
namespace {

using octree::Point;
using octree::WindingGoal;
using octree::WindingNumber;

constexpr SideResult kUnknownSide{Side::kUnknown, Status::kDegraded};

// Rounds to the nearest whole number; clamps to +-2^62.
std::int64_t rounded(double value) {
  constexpr double kMaxWindingNumber = 0x1p62;  // fits std::int64_t
  return static_cast<std::int64_t>(
      std::clamp(value + (value < 0 ? -0.5 : 0.5), -kMaxWindingNumber, kMaxWindingNumber));
}

}  // namespace

SideResult OpenSide::run(const SideResult& result) {
  if (result.side == Side::kUnknown) return result;
  if (caps_cannot_matter()) {
    if (reason_) reason_->caps_cannot_matter = true;
    return result;
  }
  SideResult closed = result;
  if (closed.side == Side::kOnSurface) return beside_triangles(closed);
  const bool is_exact = !search_ || search_->has_exact_winding();
  const double known = is_exact ? static_cast<double>(closed.winding) : 0;
  WindingNumber w = less_caps({known, 0}, WindingGoal::kHalf);
  // If only the sign is known, a share of the caps below one half suffices.
  if (!is_exact && !w.on_surface && w.below_half()) return closed;
  if (!is_exact && !w.on_surface) {
    if (!know_exactly(closed)) return kUnknownSide;
    w = less_caps({static_cast<double>(closed.winding), 0}, WindingGoal::kHalf);
  }
  return w.on_surface ? beside_triangles(closed)
                      : result_of(w, static_cast<double>(closed.winding));
}

// Whether the share of the caps is below one half because they are far away or small.
bool OpenSide::caps_cannot_matter() const {
  if (model_.cap_grid.is_clear(point_)) return true;
  if (!(point_.cwiseAbs().maxCoeff() <= octree::kMaxQueryCoordinate)) return true;
  const Point gap = (model_.tree.box_lower - point_).cwiseMax(point_ - model_.tree.box_upper);
  // 4 pi times 0.48.
  constexpr double kLargeAngle = 6;
  return model_.cap_area < kLargeAngle * gap.cwiseMax(0.0).squaredNorm();
}

// Counts the winding number with the caps if only its sign is known.
bool OpenSide::know_exactly(SideResult& closed) {
  if (!search_ || search_->has_exact_winding()) return true;
  closed = search_->count_exactly(limit_.left());
  return closed.side != Side::kUnknown;
}

// For a point on the surface or on a cap. Winding numbers there have the triangles at the point
// left out.
SideResult OpenSide::beside_triangles(const SideResult& found) {
  const bool on_surface = found.side == Side::kOnSurface;
  const SideResult on{Side::kOnSurface, Status::kExact, 0, false, false};
  SideResult closed = found;
  if (!know_exactly(closed)) return on_surface ? on : kUnknownSide;
  const octree::StarShare star =
      octree::star_share(model_.tree, point_, limit_.left(), pages_, work_);
  if (!star.complete) return on_surface ? on : kUnknownSide;
  const octree::WindingBase base{static_cast<double>(closed.winding) - star.value,
                                 star.error + octree::kStarRounding * (1 + std::fabs(star.value))};
  const WindingNumber w = less_caps(base, on_surface ? WindingGoal::kSign : WindingGoal::kHalf);
  if (!on_surface) return result_of(w, static_cast<double>(closed.winding));
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

}  // namespace planetree::query
