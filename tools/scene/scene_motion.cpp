#include "tools/scene/scene_motion.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/rigid_transform.h"

namespace planetree::tools {
namespace {

double speed_of(const Vec3& velocity) { return std::hypot(velocity.x, velocity.y, velocity.z); }

bool is_still(const Twist& twist) {
  return speed_of(twist.linear) == 0 && speed_of(twist.angular) == 0;
}

}  // namespace

Pose pose_after(const InstanceDescription& instance, double seconds) {
  Pose pose = instance.pose;
  const Vec3 &linear = instance.twist.linear, &angular = instance.twist.angular;
  pose.translation.x += linear.x * seconds;
  pose.translation.y += linear.y * seconds;
  pose.translation.z += linear.z * seconds;
  const double speed = speed_of(angular);
  if (speed == 0) return pose;
  const double half = 0.5 * speed * seconds;
  const double s = std::sin(half) / speed;
  pose.rotation = octree::product({std::cos(half), s * angular.x, s * angular.y, s * angular.z},
                                  instance.pose.rotation);
  return pose;
}

SceneMotion::SceneMotion(const SceneDescription& description, OpenedScene& opened,
                         std::chrono::nanoseconds period)
    : description_(description), opened_(opened), period_(period) {
  for (std::size_t i = 0; i < description.instances.size(); ++i)
    if (!is_still(description.instances[i].twist)) moving_.push_back(i);
}

double SceneMotion::seconds_at(std::size_t tick) const {
  return 1e-9 * static_cast<double>(period_.count()) * static_cast<double>(tick);
}

Result<void> SceneMotion::check(std::size_t ticks) const {
  // The origin moves straight, so that it is in range if it is at the end.
  const double seconds = seconds_at(ticks);
  for (const std::size_t i : moving_)
    if (!octree::RigidTransform::of(pose_after(description_.instances[i], seconds)))
      return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                        "instances[%zu] moves beyond coordinates of 2^500 or turns too fast within "
                        "%g seconds; reduce its velocities, or make the session shorter",
                        i, seconds);
  return {};
}

void SceneMotion::begin_tick(std::size_t tick) const noexcept {
  const double seconds = seconds_at(tick);
  for (const std::size_t i : moving_) {
    const InstanceDescription& instance = description_.instances[i];
    // check() has seen that the pose is valid.
    (void)opened_.scene.set_pose(opened_.ids[i], pose_after(instance, seconds), instance.twist);
  }
}

bool SceneMotion::moves(std::size_t instance) const {
  return std::ranges::binary_search(moving_, instance);
}

}  // namespace planetree::tools
