#include "planetree/point_shell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "octree/geometry/rigid_transform.h"
#include "tests/query/sample_model.h"
#include "tests/query/shell/shells.h"

namespace planetree::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A ball of 300 points and radius 0.3 beside a sphere of 8,192 triangles and radius 1.
class PointShellTest : public testing::Test {
 protected:
  PointShellState make_state() { return std::move(*PointShellState::create(shell_, model_)); }
  Wrench wrench(const Pose& pose, const ShellOptions& options = {}) {
    return shell_.wrench(probe_, state_, pose, options, contacts_);
  }
  std::span<const ShellContact> listed(const Wrench& found) const {
    return std::span(contacts_).first(found.listed);
  }
  // The ball's lowest point is about `gap` above the sphere.
  static Pose above(double gap) { return {turned_by(10 * gap), {0.1, 0.2, 1.28 + gap}}; }

  const SampleModel sample_ = SampleModel::masked(octree::sphere(5));
  const Model model_ = sample_.open(std::uint64_t{64} << 20, 2);
  Probe probe_ = make_probe(model_);
  const std::vector<ShellPoint> points_ = ball_shell(300, 0.3);
  const PointShell shell_ = std::move(*PointShell::create(points_));
  PointShellState state_ = make_state();
  std::vector<ShellContact> contacts_ = std::vector<ShellContact>(points_.size());
};

TEST_F(PointShellTest, FindsEveryPointAsDeepAsItsOwnQuery) {
  Probe other = make_probe(model_);
  std::size_t contacts = 0, in_contact = 0, queries = 0;
  for (int i = 0; i < 300; ++i) {
    const Pose pose = above(0.02 - 0.0004 * i);
    ShellOptions options;
    options.margin = i % 4 < 2 ? 0 : 0.01;
    options.depth_rule = i % 5 == 0 ? DepthRule::kTwoSided : DepthRule::kSolid;
    options.max_depth = i % 3 == 0 ? 0.02 : kInfinity;
    const Wrench found = wrench(pose, options);
    ASSERT_EQ(found.status, Status::kExact);
    std::vector<double> depths(points_.size());
    for (const ShellContact& contact : listed(found)) depths[contact.point] = contact.depth;
    const auto transform = octree::RigidTransform::of(pose);
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const ClosestPoint answer = other.closest_point(transform->apply(points_[k].position));
      const double distance =
          options.depth_rule == DepthRule::kSolid ? answer.signed_distance() : answer.distance;
      ASSERT_EQ(depths[k], std::clamp(options.margin - distance, 0.0, options.max_depth)) << k;
      in_contact += depths[k] > 0;
    }
    contacts += found.contacts;
    queries += found.queries;
  }
  EXPECT_EQ(contacts, in_contact);
  EXPECT_GT(contacts, 3000u);
  EXPECT_LT(queries, 300 * points_.size() / 4);
}

TEST_F(PointShellTest, SumsForceAndTorqueOfItsContacts) {
  const ShellOptions options{.stiffness = 3, .margin = 0.01, .reference = {0.1, -0.2, 0.3}};
  const Pose pose = above(-0.05);
  const Wrench found = wrench(pose, options);
  ASSERT_GT(found.contacts, 10u);
  const auto transform = octree::RigidTransform::of(pose);
  const Vec3 about = transform->apply(options.reference);
  Vec3 force, torque;
  for (const ShellContact& contact : listed(found)) {
    const Vec3 inward = transform->rotate(points_[contact.point].normal);
    EXPECT_NEAR(contact.direction.x, inward.x, 1e-15);
    EXPECT_NEAR(contact.direction.y, inward.y, 1e-15);
    EXPECT_NEAR(contact.direction.z, inward.z, 1e-15);
    EXPECT_EQ(contact.status, Status::kExact);
    const double size = options.stiffness * contact.depth;
    const Vec3 f{size * inward.x, size * inward.y, size * inward.z};
    const Vec3 r{contact.position.x - about.x, contact.position.y - about.y,
                 contact.position.z - about.z};
    force = {force.x + f.x, force.y + f.y, force.z + f.z};
    torque = {torque.x + r.y * f.z - r.z * f.y, torque.y + r.z * f.x - r.x * f.z,
              torque.z + r.x * f.y - r.y * f.x};
  }
  EXPECT_NEAR(found.force.x, force.x, 1e-12);
  EXPECT_NEAR(found.force.y, force.y, 1e-12);
  EXPECT_NEAR(found.force.z, force.z, 1e-12);
  EXPECT_NEAR(found.torque.x, torque.x, 1e-12);
  EXPECT_NEAR(found.torque.y, torque.y, 1e-12);
  EXPECT_NEAR(found.torque.z, torque.z, 1e-12);
  EXPECT_GT(found.force.z, 0);
  EXPECT_LT(found.force_error, 1e-11);
  EXPECT_LT(found.torque_error, 1e-11);
}

TEST_F(PointShellTest, ListsContactsInTheOrderOfTheirNumbers) {
  const Wrench found = wrench(above(-0.05));
  const auto all = listed(found);
  EXPECT_TRUE(std::ranges::is_sorted(all, {}, &ShellContact::point));
  std::vector<ShellContact> few(5);
  const Wrench again = shell_.wrench(probe_, state_, above(-0.05), {}, few);
  EXPECT_EQ(bits_of(again), bits_of(found));
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(few[i].point, all[i].point);
}

TEST_F(PointShellTest, FarAwayTakesOneQueryAndThenNone) {
  const Wrench first = wrench(above(2));
  EXPECT_EQ(first.status, Status::kExact);
  EXPECT_EQ(first.queries, 1u);
  EXPECT_EQ(first.contacts, 0u);
  EXPECT_EQ(first.force_error, 0);
  EXPECT_EQ(wrench(above(1.9)).queries, 0u);
  state_.reset();
  EXPECT_EQ(wrench(above(1.9)).queries, 1u);
}

TEST_F(PointShellTest, DeepInsideTakesOneQueryForAllPoints) {
  const ShellOptions options{.max_depth = 0.1};
  const Wrench found = wrench({{}, {0.05, 0, 0}}, options);
  EXPECT_EQ(found.queries, 1u);
  EXPECT_EQ(found.contacts, points_.size());
  EXPECT_EQ(found.status, Status::kExact);
  for (const ShellContact& contact : listed(found)) EXPECT_EQ(contact.depth, 0.1);
}

TEST_F(PointShellTest, AsksOnlyForPointsThatMayTouch) {
  std::size_t queries = 0, contacts = 0;
  for (int i = 0; i < 400; ++i) {
    const Wrench found = wrench(above(0.01 - 0.0001 * i));
    queries += found.queries;
    contacts += found.contacts;
  }
  EXPECT_GT(contacts, 1000u);
  // Of 120,000 points.
  EXPECT_LT(queries, 3 * contacts);
}

TEST_F(PointShellTest, ExactResultsDoNotDependOnHistory) {
  PointShellState fresh = make_state();
  Probe other = make_probe(model_);
  std::size_t asked = 0, asked_afresh = 0;
  for (int i = 0; i < 300; ++i) {
    ShellOptions options{.margin = i % 40 < 20 ? 0.0 : 0.01};
    if (i % 50 > 40) options.max_depth = 0.01;
    if (i % 30 > 25) options.depth_rule = DepthRule::kTwoSided;
    // Jumps between steps.
    const Pose pose = above(i % 25 == 0 ? 0.3 : 0.01 - 0.0002 * i);
    const Wrench kept = wrench(pose, options);
    fresh.reset();
    const Wrench expected = shell_.wrench(other, fresh, pose, options);
    ASSERT_EQ(kept.status, Status::kExact);
    ASSERT_EQ(bits_of(kept), bits_of(expected)) << i;
    asked += kept.queries;
    asked_afresh += expected.queries;
  }
  EXPECT_LT(asked, asked_afresh);
}

TEST_F(PointShellTest, TakesDirectionsOfTheModelOnRequest) {
  ShellOptions options{.margin = 0.02, .force_direction = ForceDirection::kModelNormal};
  Probe other = make_probe(model_);
  for (const DepthRule rule : {DepthRule::kSolid, DepthRule::kTwoSided}) {
    options.depth_rule = rule;
    const Wrench found = wrench(above(-0.01), options);
    EXPECT_EQ(found.status, Status::kExact);
    ASSERT_GT(found.contacts, 5u);
    for (const ShellContact& contact : listed(found)) {
      const ClosestPoint answer = other.closest_point(
          contact.position, {.normal_rule = rule == DepthRule::kSolid ? NormalRule::kOutward
                                                                      : NormalRule::kTowardQuery});
      EXPECT_EQ(contact.direction.x, answer.normal.x);
      EXPECT_EQ(contact.direction.y, answer.normal.y);
      EXPECT_EQ(contact.direction.z, answer.normal.z);
    }
  }
}

TEST_F(PointShellTest, WithoutSidesKnowsNoDepthOfASolidAndThatOfAWall) {
  OpenOptions open;
  open.layers = kDistanceLayer;
  const auto model = Model::open(sample_.path(), open);
  ASSERT_TRUE(model);
  Probe probe = make_probe(*model);
  PointShellState state = *PointShellState::create(shell_, *model);
  const Pose pose = above(0.001);
  const Wrench solid = shell_.wrench(probe, state, pose, {.margin = 0.01}, contacts_);
  EXPECT_EQ(solid.status, Status::kDegraded);
  EXPECT_EQ(solid.undecided, points_.size());
  const Wrench wall =
      shell_.wrench(probe, state, pose, {.margin = 0.01, .depth_rule = DepthRule::kTwoSided});
  EXPECT_EQ(wall.status, Status::kExact);
  EXPECT_GT(wall.contacts, 0u);
}

TEST_F(PointShellTest, MovesWithItsStates) {
  PointShell shell = *PointShell::create(points_);
  PointShellState state = *PointShellState::create(shell, model_);
  const PointShell moved(std::move(shell));
  PointShellState moved_state(std::move(state));
  EXPECT_EQ(moved.size(), points_.size());
  EXPECT_EQ(bits_of(moved.wrench(probe_, moved_state, above(-0.05))),
            bits_of(wrench(above(-0.05))));
}

TEST_F(PointShellTest, SaysThatForcesOverflow) {
  const Wrench found = wrench(above(-0.3), {.stiffness = 1e308});
  EXPECT_EQ(found.status, Status::kDegraded);
  EXPECT_EQ(found.force.x, 0);
  EXPECT_EQ(found.force_error, kInfinity);
  EXPECT_EQ(found.torque_error, kInfinity);
}

TEST_F(PointShellTest, IsFreeAnywhereFarAway) {
  for (const double far : {1e10, 1e30, 1e100, 1e150}) {
    const Wrench found = wrench({turned_by(1), {0, far, -far}}, {.margin = 0.1});
    EXPECT_EQ(found.status, Status::kExact) << far;
    EXPECT_EQ(found.force_error, 0) << far;
    EXPECT_EQ(found.queries, 1u) << far;
  }
}

void expect_refused(const Wrench& wrench) {
  EXPECT_EQ(wrench.status, Status::kBadQuery);
  EXPECT_EQ(wrench.force.x, 0);
  EXPECT_EQ(wrench.force_error, kInfinity);
  EXPECT_EQ(wrench.torque_error, kInfinity);
  EXPECT_EQ(wrench.queries, 0u);
}

TEST_F(PointShellTest, RefusesPosesOutOfRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused(wrench({{1.001, 0, 0, 0}, {}}));
  expect_refused(wrench({{0, 0, 0, 0}, {}}));
  expect_refused(wrench({{nan, 0, 0, 0}, {}}));
  expect_refused(wrench({{}, {0, nan, 0}}));
  expect_refused(wrench({{}, {0, 0, kInfinity}}));
  expect_refused(wrench({{}, {1e300, 0, 0}}));
  EXPECT_EQ(wrench({{1 + 0x1p-22, 0, 0, 0}, {0, 0, 3}}).status, Status::kExact);
}

TEST_F(PointShellTest, RefusesOptionsOutOfRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-1.0, nan, kInfinity}) {
    expect_refused(wrench({}, {.stiffness = bad}));
    expect_refused(wrench({}, {.margin = bad}));
    expect_refused(wrench({}, {.reference = {0, bad * 1e300, 0}}));
    if (!(bad > 0)) expect_refused(wrench({}, {.max_depth = bad}));
  }
  expect_refused(wrench({}, {.depth_rule = static_cast<DepthRule>(7)}));
  expect_refused(wrench({}, {.force_direction = static_cast<ForceDirection>(7)}));
  expect_refused(wrench({}, {.side_rule = static_cast<SideRule>(7)}));
  expect_refused(wrench({}, {.wait = static_cast<Wait>(7)}));
}

TEST(PointShell, RefusesPointsOutOfRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto code_of = [](const ShellPoint& point) {
    const ShellPoint points[] = {{}, point};
    const auto shell = PointShell::create(points);
    return shell ? ErrorCode{} : shell.error().code;
  };
  EXPECT_EQ(code_of({}), ErrorCode{});
  EXPECT_FALSE(PointShell::create({}));
  EXPECT_EQ(code_of({{nan, 0, 0}, {0, 0, 1}}), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of({{0, 1e160, 0}, {0, 0, 1}}), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of({{}, {0, 0, 1.001}}), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of({{}, {0, nan, 1}}), ErrorCode::kBadArgument);
}

}  // namespace
}  // namespace planetree::query
