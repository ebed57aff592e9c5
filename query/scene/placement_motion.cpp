#include "query/scene/placement_motion.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "query/shell/vectors.h"

// In the frame of the instance the ball's centre is x(t) = R(t)^T d(t), where d(t), the centre less
// the origin of the instance, moves straight from d0 to d1, and R(t) turns by the angle a t. The
// second derivative of x is at most a^2 |d| + 2 a |d1 - d0|. A straight motion with the same ends
// is off by an eighth of that at most, at any t.

namespace planetree::query {
namespace {

// Cosine and sine of h divided by h, for h up to 1/2, by the first terms of their series. The next
// terms are below 2^-55. No function of the mathematics library is used, so that answers are the
// same everywhere.
double cosine(double square) {
  double sum = 1;
  for (const double divisor : {13.0 * 14, 11.0 * 12, 9.0 * 10, 7.0 * 8, 5.0 * 6, 3.0 * 4, 1.0 * 2})
    sum = 1 - square / divisor * sum;
  return sum;
}
double sine_by_angle(double square) {
  double sum = 1;
  for (const double divisor : {12.0 * 13, 10.0 * 11, 8.0 * 9, 6.0 * 7, 4.0 * 5, 2.0 * 3})
    sum = 1 - square / divisor * sum;
  return sum;
}

// The pose after a time, whose angle is at most kMaxAngle.
Pose moved(const Placement& placement, double seconds) {
  const Vec3 half = placement.twist.angular * (seconds / 2);
  const double square = dot(half, half), sine = sine_by_angle(square);
  const Quaternion turn{cosine(square), half.x * sine, half.y * sine, half.z * sine};
  return {octree::product(turn, placement.pose.rotation),
          placement.pose.translation + placement.twist.linear * seconds};
}

bool is_zero(const Vec3& v) { return v.x == 0 && v.y == 0 && v.z == 0; }

// The quaternion of a pose that moved() returns is off by less than 32 units of 2^-53 of its
// length, which turns by twice as much; the translation by 4 of its terms.
constexpr double kMovedRounding = 0x1p-47;

}  // namespace

std::optional<PlacementMotion> PlacementMotion::of(const Placement& start, double seconds) {
  PlacementMotion motion;
  motion.placement_ = start;
  motion.seconds_ = seconds;
  const double turn = upper_length(start.twist.angular) * seconds;
  motion.is_still_ = seconds == 0 || (is_zero(start.twist.linear) && is_zero(start.twist.angular));
  motion.start_ = *octree::RigidTransform::of(start.pose);
  motion.end_ = motion.start_;
  if (motion.is_still_) return motion;
  if (!(turn <= kMaxAngle)) return {};
  motion.angle_ = turn * (1 + octree::kNormRounding);
  const auto end = octree::RigidTransform::of(moved(start, seconds));
  if (!end) return {};
  motion.end_ = *end;
  return motion;
}

octree::RigidTransform PlacementMotion::at(double t) const {
  if (is_still_ || t == 0) return start_;
  return octree::RigidTransform::of(moved(placement_, t * seconds_)).value_or(end_);
}

PlacementMotion::LocalSweep PlacementMotion::to_local(const Sweep& sweep) const {
  if (is_identity()) return {sweep, 0};
  const Vec3 from = sweep.from - start_.translation(), to = sweep.to - end_.translation();
  const double reach = std::max(upper_length(from), upper_length(to));
  double error = std::max(start_.position_error(reach), end_.position_error(reach));
  if (!is_still_) {
    const double origins = upper_length(placement_.pose.translation) +
                           upper_length(placement_.twist.linear) * seconds_;
    const double bend =
        angle_ * (angle_ * reach + 2 * upper_length(to - from)) / 8 * (1 + octree::kNormRounding);
    error += bend + kMovedRounding * (reach + origins);
  }
  return {{start_.apply_inverse(sweep.from), end_.apply_inverse(sweep.to), sweep.radius}, error};
}

double PlacementMotion::way_bound(const Twist& twist, double seconds, double reach) {
  if (seconds == 0) return 0;
  return (upper_length(twist.linear) + upper_length(twist.angular) * reach) * seconds *
         (1 + octree::kNormRounding);
}

}  // namespace planetree::query
