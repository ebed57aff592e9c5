// Wrenches of point shells in random poses on difficult models, against all triangles.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "octree/geometry/rigid_transform.h"
#include "planetree/point_shell.h"
#include "tests/oracle/closed_models.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/queries/wrench_oracle.h"
#include "tests/oracle/sheet_models.h"

namespace planetree::oracle {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Case {
  BuiltModel model;
  std::vector<ShellPoint> points;
  PointShell shell;
  PointShellState state;
  std::vector<ShellContact> contacts;

  Case(Soup soup, std::vector<ShellPoint> shell_points)
      : model(std::move(soup), {4096}),
        points(std::move(shell_points)),
        shell(std::move(*PointShell::create(points))),
        state(std::move(*PointShellState::create(shell, model.model()))),
        contacts(points.size()) {}

  Wrench wrench(const Pose& pose, const ShellOptions& options) {
    return shell.wrench(model.probe(), state, pose, options, contacts);
  }
};

// In contact, deep, or far away.
Pose random_pose(Random& random, const Soup& soup) {
  const Vec3 at = nasty_query(random, soup, 1);
  return {random_rotation(random), at};
}

ShellOptions random_options(Random& random) {
  ShellOptions options;
  options.stiffness = random.magnitude(-3, 10);
  options.margin = random.one_in(2) ? random.magnitude(-12, -2) : 0;
  options.max_depth = random.one_in(3) ? random.magnitude(-8, 0) : kInfinity;
  options.depth_rule = random.one_in(3) ? DepthRule::kTwoSided : DepthRule::kSolid;
  options.side_rule = SideRule::kSolid;
  if (random.one_in(2)) options.reference = random.in_cube();
  return options;
}

void expect_holds(Case& one, const Pose& pose, const ShellOptions& options, const Wrench& wrench) {
  const WrenchTruth truth = wrench_truth(
      one.model.triangles(), one.model.model().info().watertight(), one.points, pose, options);
  EXPECT_LE(distance_between(wrench.force, truth.force), wrench.force_error + truth.force_slack);
  EXPECT_LE(distance_between(wrench.torque, truth.torque),
            wrench.torque_error + truth.torque_slack);
  const auto deeper = [&](long double depth) { return depth > truth.depth_slack; };
  const auto in_contact = std::ranges::count_if(truth.depths, deeper);
  EXPECT_LE(static_cast<std::size_t>(in_contact), wrench.contacts + wrench.undecided);
  // Every point in contact is listed, with an interval that holds.
  std::vector<bool> listed(one.points.size());
  for (const ShellContact& contact : std::span(one.contacts).first(wrench.listed)) {
    EXPECT_GT(contact.depth_upper, 0);
    listed[contact.point] = true;
    const long double depth = truth.depths[contact.point];
    EXPECT_LE(contact.depth_lower, depth + truth.depth_slack);
    EXPECT_GE(contact.depth_upper, depth - truth.depth_slack);
    EXPECT_LE(contact.depth_lower, contact.depth);
    EXPECT_GE(contact.depth_upper, contact.depth);
  }
  for (std::size_t i = 0; i < listed.size(); ++i)
    EXPECT_TRUE(listed[i] || !deeper(truth.depths[i])) << i;
}

void expect_wrenches_hold(std::span<const NastyFamily> families, int poses) {
  for (const NastyFamily& family : families) {
    SCOPED_TRACE(std::string(family.name));
    Random random(7);
    Soup soup = family.make(random);
    const double radius = random.magnitude(-5, 0);
    Case one(std::move(soup), ball_shell(random, 1 + random.below(60), radius));
    int exact = 0;
    for (int i = 0; i < poses; ++i) {
      const Pose pose = random_pose(random, one.model.triangles());
      const ShellOptions options = random_options(random);
      // First with the pages of earlier poses alone.
      ShellOptions at_once = options;
      at_once.wait = Wait::kNever;
      expect_holds(one, pose, options, one.wrench(pose, at_once));
      const Wrench wrench = one.wrench(pose, options);
      expect_holds(one, pose, options, wrench);
      EXPECT_EQ(wrench.status == Status::kExact, wrench.undecided == 0);
      exact += wrench.status == Status::kExact;
      // Little work.
      ShellOptions limited = options;
      limited.max_work = static_cast<std::uint32_t>(random.below(60));
      if (random.one_in(2)) one.state.reset();
      const Wrench less = one.wrench(pose, limited);
      EXPECT_LE(less.work, limited.max_work);
      expect_holds(one, pose, options, less);
      if (testing::Test::HasFailure()) return;
    }
    EXPECT_GE(exact, poses * 9 / 10);
  }
}

TEST(PointShellOnClosedModels, HasTheWrenchOfAllTriangles) {
  expect_wrenches_hold(closed_families(), static_cast<int>(8 * test_effort()));
}

TEST(PointShellOnNastyModels, HasTheWrenchOfAllTriangles) {
  expect_wrenches_hold(nasty_families(), static_cast<int>(8 * test_effort()));
}

// Behind the border of a sheet the side changes where no surface is.
TEST(PointShellOnSheets, HasTheSidesOfItsPoints) {
  for (const SideRule rule : {SideRule::kSurface, SideRule::kSolid}) {
    Random random(3);
    Case one(hills(12), ball_shell(random, 80, 0.2));
    std::size_t contacts = 0, free = 0;
    for (int i = 0; i < 40; ++i) {
      const Vec3 at = random.in_cube() * 1.2;
      const Pose pose{random_rotation(random), {at.x, at.y, 0.4 * at.z}};
      ShellOptions options{.margin = 0.02};
      options.side_rule = rule;
      const Wrench wrench = one.wrench(pose, options);
      EXPECT_EQ(wrench.status, Status::kExact);
      std::vector<double> depths(one.points.size());
      for (const ShellContact& contact : std::span(one.contacts).first(wrench.listed))
        depths[contact.point] = contact.depth;
      const auto transform = octree::RigidTransform::of(pose);
      for (std::size_t k = 0; k < one.points.size(); ++k) {
        const ClosestPoint answer =
            one.model.closest_point(transform->apply(one.points[k].position), {.side_rule = rule});
        ASSERT_EQ(depths[k], std::max(0.0, options.margin - answer.signed_distance()));
        (depths[k] > 0 ? contacts : free) += 1;
      }
    }
    EXPECT_GT(contacts, rule == SideRule::kSurface ? 1000u : 20u);
    EXPECT_GT(free, 500u);
  }
}

}  // namespace
}  // namespace planetree::oracle
