#include "tests/oracle/queries/wrench_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tests/oracle/nasty_models.h"
#include "tests/oracle/winding.h"

namespace planetree::oracle {
namespace {

Extended extended(const Vec3& a) { return {a.x, a.y, a.z}; }

Extended cross(const Extended& a, const Extended& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

long double length(const Extended& a) { return std::hypot(a[0], a[1], a[2]); }

// v + 2 w (q x v) + 2 q x (q x v), where (w, q) is the quaternion divided by its length.
Extended rotated(const Quaternion& rotation, const Extended& v) {
  const long double w = rotation.w, x = rotation.x, y = rotation.y, z = rotation.z;
  const long double size = std::sqrt(w * w + x * x + y * y + z * z);
  const Extended q{x / size, y / size, z / size};
  const Extended once = cross(q, v), twice = cross(q, once);
  Extended turned;
  for (std::size_t i = 0; i < 3; ++i) turned[i] = v[i] + 2 * (w / size) * once[i] + 2 * twice[i];
  return turned;
}

bool is_inside(std::span<const Corners> triangles, bool is_watertight, const Vec3& at) {
  if (is_watertight) return exact_side(at, triangles) == Side::kInside;
  const OpenWinding winding = open_winding(at, triangles);
  return !winding.on_surface && std::fabs(winding.value) > 0.5L;
}

}  // namespace

WrenchTruth wrench_truth(std::span<const Corners> triangles, bool is_watertight,
                         std::span<const ShellPoint> points, const Pose& pose,
                         const ShellOptions& options) {
  WrenchTruth truth;
  const Extended translation = extended(pose.translation), reference = extended(options.reference);
  for (const ShellPoint& point : points) {
    Extended at = rotated(pose.rotation, extended(point.position)), arm = extended(point.position);
    for (std::size_t i = 0; i < 3; ++i) at[i] += translation[i], arm[i] -= reference[i];
    const Vec3 rounded{static_cast<double>(at[0]), static_cast<double>(at[1]),
                       static_cast<double>(at[2])};
    const long double slack = distance_between(rounded, at) + 1e-18L * length(at);
    long double distance = exact_distance(rounded, triangles).convert_to<long double>();
    if (options.depth_rule == DepthRule::kSolid && is_inside(triangles, is_watertight, rounded))
      distance = -distance;
    const long double depth =
        std::clamp<long double>(options.margin - distance, 0, options.max_depth);
    const Extended normal = extended(point.normal);
    Extended direction = rotated(pose.rotation, normal);
    for (long double& component : direction) component /= length(normal);
    const Extended moment = cross(rotated(pose.rotation, arm), direction);
    for (std::size_t i = 0; i < 3; ++i) {
      truth.force[i] += options.stiffness * depth * direction[i];
      truth.torque[i] += options.stiffness * depth * moment[i];
    }
    truth.depths.push_back(depth);
    truth.depth_slack = std::max(truth.depth_slack, slack);
    truth.force_slack += options.stiffness * slack;
    truth.torque_slack += options.stiffness * slack * length(moment);
  }
  return truth;
}

long double distance_between(const Vec3& a, const Extended& b) {
  return length({a.x - b[0], a.y - b[1], a.z - b[2]});
}

std::vector<ShellPoint> ball_shell(Random& random, std::size_t count, double radius) {
  std::vector<ShellPoint> points;
  while (points.size() < count) {
    const Vec3 at = random.in_cube();
    const double length = std::sqrt(at.x * at.x + at.y * at.y + at.z * at.z);
    if (length > 0.2 && length < 1) points.push_back({at * (radius / length), at * (-1 / length)});
  }
  return points;
}

Quaternion random_rotation(Random& random) {
  for (;;) {
    const double w = random.either_sign(), x = random.either_sign(), y = random.either_sign(),
                 z = random.either_sign();
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    if (length > 0.1 && length <= 1) return {w / length, x / length, y / length, z / length};
  }
}

}  // namespace planetree::oracle
