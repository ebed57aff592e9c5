// Wrenches of point shells in scenes against all triangles of all their instances.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "planetree/scene_shell.h"
#include "tests/differential/scene_cases.h"
#include "tests/oracle/closed_models.h"

namespace planetree::oracle {
namespace {

// The sum of the true wrenches of all instances, each in its own frame, and what rounding the pose
// of the tool there may change.
struct SceneTruth {
  RealPoint force{}, torque{};
  Real force_slack = 0, torque_slack = 0;
};

void add_turned(const Rotation& turn, const Extended& local, RealPoint& sum) {
  const RealPoint turned = turn.of({Real(local[0]), Real(local[1]), Real(local[2])});
  for (std::size_t i = 0; i < 3; ++i) sum[i] += turned[i];
}

SceneTruth truth_of(const SceneCase& scene, std::span<const ShellPoint> points, double radius,
                    const Pose& tool, const ShellOptions& options) {
  SceneTruth truth;
  for (const Placed& each : scene.placed()) {
    const Rotation turn = rotation(each.pose.rotation);
    const Rotation relative = joined(turn.inverse(), rotation(tool.rotation));
    const Local at = to_local(each.pose, tool.translation);
    const Pose place{
        {double(relative.w), double(relative.u[0]), double(relative.u[1]), double(relative.u[2])},
        at.point};
    const bool is_watertight = each.model->model().info().watertight();
    const WrenchTruth local =
        wrench_truth(each.model->triangles(), is_watertight, points, place, options);
    add_turned(turn, local.force, truth.force);
    add_turned(turn, local.torque, truth.torque);
    const Real off = (at.slack + 1e-15 * radius) * options.stiffness * Real(points.size());
    const Real lever = 3 * radius;
    truth.force_slack += local.force_slack + off;
    truth.torque_slack += local.torque_slack + off * lever;
    // Forces turn with the rounded rotation, too.
    for (const long double depth : local.depths) {
      const Real turned = Real(1e-15) * options.stiffness * Real(depth);
      truth.force_slack += turned;
      truth.torque_slack += turned * lever;
    }
  }
  return truth;
}

Real distance_between(const Vec3& a, const RealPoint& b) {
  Real sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Real gap = real(a)[i] - b[i];
    sum += gap * gap;
  }
  return sqrt(sum);
}

void expect_holds(const SceneTruth& truth, const Wrench& wrench) {
  EXPECT_LE(distance_between(wrench.force, truth.force),
            Real(wrench.force_error) + truth.force_slack);
  EXPECT_LE(distance_between(wrench.torque, truth.torque),
            Real(wrench.torque_error) + truth.torque_slack);
}

void check_wrenches(std::span<const NastyFamily> families, std::size_t seed) {
  Random random(seed);
  std::size_t contacts = 0, exact = 0, tight = 0, total = 0;
  for (int i = 0; i < 4 * test_effort(); ++i) {
    SceneCase scene(random, families);
    const double radius = random.magnitude(-5, 0);
    const auto points = ball_shell(random, 1 + random.below(40), radius);
    const PointShell shell = std::move(*PointShell::create(points));
    SceneShellState state =
        std::move(*SceneShellState::create(shell, static_cast<std::uint32_t>(1 + random.below(4))));
    for (int k = 0; k < 8 && !testing::Test::HasFailure(); ++k) {
      SCOPED_TRACE(testing::Message() << "scene " << i << " pose " << k);
      scene.move_some(random);
      const Vec3 at = scene.query(random);
      if (std::fabs(at.x) + std::fabs(at.y) + std::fabs(at.z) > 1e20) continue;
      const Pose pose{random_rotation(random), at};
      ShellOptions options;
      // Great margins reach several instances.
      options.margin = random.one_in(3) ? random.magnitude(-2, 5) : random.magnitude(-12, -2);
      options.reference = random.in_cube() * radius;
      options.max_depth = random.one_in(2) ? random.magnitude(-8, 0) : 100;
      options.depth_rule = random.one_in(3) ? DepthRule::kTwoSided : DepthRule::kSolid;
      options.side_rule = SideRule::kSolid;
      const SceneTruth truth = truth_of(scene, points, radius, pose, options);
      ShellOptions at_once = options;
      at_once.wait = Wait::kNever;
      expect_holds(truth, shell.wrench(scene.probe(), state, pose, at_once));
      const Wrench wrench = shell.wrench(scene.probe(), state, pose, options);
      expect_holds(truth, wrench);
      contacts += wrench.contacts;
      exact += wrench.status == Status::kExact;
      tight += wrench.force_error < 1e-6 * (1 + std::fabs(wrench.force.x));
      ++total;
    }
  }
  EXPECT_GT(contacts, 100u);
  EXPECT_GT(exact, total / 2);
  EXPECT_GT(tight, total / 2);
}

TEST(ScenesOfClosedModels, PushToolsAsAllTrianglesDo) { check_wrenches(closed_families(), 9); }
TEST(ScenesOfNastyModels, PushToolsAsAllTrianglesDo) { check_wrenches(nasty_families(), 10); }

}  // namespace
}  // namespace planetree::oracle
