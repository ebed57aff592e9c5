#include "planetree/scene_shell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "tests/query/scene/scene_fixture.h"
#include "tests/query/shell/shells.h"

namespace planetree::query {
namespace {

// A tool of 300 points on a ball of radius 0.5.
class SceneShell : public SceneFixture {
 protected:
  SceneShellState state(std::uint32_t instances = 4) const {
    return std::move(*SceneShellState::create(shell_, instances));
  }

  const PointShell shell_ = std::move(*PointShell::create(ball_shell(300, 0.5)));
  const ShellOptions options_{.margin = 0.01, .max_depth = 0.3};
};

TEST_F(SceneShell, OfOneStillInstanceIsPushedAsByItsModel) {
  const Model model = fine_ball_.open();
  Scene scene = make_scene();
  const InstanceId ball = add(scene, fine_ball_);
  Probe alone = query::make_probe(model);
  SceneProbe probe = make_probe(scene);
  PointShellState state_alone = std::move(*PointShellState::create(shell_, model));
  SceneShellState states = state();
  std::vector<ShellContact> list_alone(300);
  std::vector<SceneShellContact> list(300);
  std::size_t contacts = 0;
  for (int i = 0; i < 40; ++i) {
    const Pose pose{turned_by(0.2 * i), {1.3 + 0.01 * (i % 20), 0.1, 0.2}};
    const Wrench wrench = shell_.wrench(probe, states, pose, options_, list);
    const Wrench wrench_alone = shell_.wrench(alone, state_alone, pose, options_, list_alone);
    EXPECT_EQ(bits_of(wrench), bits_of(wrench_alone));
    EXPECT_EQ(wrench.queries, wrench_alone.queries);
    EXPECT_EQ(wrench.work, wrench_alone.work);
    ASSERT_EQ(wrench.listed, wrench_alone.listed);
    for (std::size_t k = 0; k < wrench.listed; ++k) {
      EXPECT_EQ(list[k].instance, ball);
      EXPECT_EQ(list[k].point, list_alone[k].point);
      EXPECT_EQ(list[k].depth, list_alone[k].depth);
    }
    contacts += wrench.contacts;
  }
  EXPECT_GT(contacts, 100u);
}

// Two spheres squeeze the tool from the left and from the right.
TEST_F(SceneShell, IsPushedByAllInstances) {
  Scene scene = make_scene();
  const InstanceId right = add(scene, fine_ball_, at(1.48));
  SceneProbe probe = make_probe(scene);
  SceneShellState states = state();
  const Wrench one = shell_.wrench(probe, states, {}, options_);
  EXPECT_EQ(one.status, Status::kExact);
  EXPECT_LT(one.force.x, -0.03);
  const InstanceId left = add(scene, fine_ball_, {{0.8, 0, 0.6, 0}, {-1.48, 0, 0}});
  std::vector<SceneShellContact> list(600);
  const Wrench both = shell_.wrench(probe, states, {}, options_, list);
  EXPECT_EQ(both.status, Status::kExact);
  EXPECT_NEAR(both.force.x, 0, std::fabs(one.force.x) / 2);
  EXPECT_GT(both.contacts, one.contacts);
  EXPECT_LT(both.force_error, 1e-10);
  for (const SceneShellContact& contact : std::span(list).first(both.listed)) {
    EXPECT_EQ(contact.instance, contact.position.x > 0 ? right : left);
    EXPECT_EQ(contact.direction.x > 0, contact.position.x < 0);
  }
  // With memory for one of them, it is the same.
  SceneShellState little = state(1);
  EXPECT_EQ(bits_of(shell_.wrench(probe, little, {}, options_)), bits_of(both));
  EXPECT_EQ(bits_of(shell_.wrench(probe, little, {}, options_)), bits_of(both));
}

TEST_F(SceneShell, DoesNotAskInstancesOutOfReach) {
  Scene scene = make_scene();
  add(scene, ball_, at(1.45));
  SceneProbe probe = make_probe(scene);
  SceneShellState states = state();
  const Wrench alone = shell_.wrench(probe, states, {}, options_);
  for (int i = 0; i < 50; ++i) add(scene, fine_ball_, at(6.0 + 3 * i));
  states.reset();
  const Wrench wrench = shell_.wrench(probe, states, {}, options_);
  EXPECT_EQ(bits_of(wrench), bits_of(alone));
  EXPECT_EQ(wrench.queries, alone.queries);
  const Wrench none = shell_.wrench(probe, states, {{}, {0, 9, 0}}, options_);
  EXPECT_EQ(none.status, Status::kExact);
  EXPECT_EQ(none.force_error, 0);
  EXPECT_EQ(none.queries, 0u);
}

// What is known of an instance ages as the instance moves, though the tool stands still.
TEST_F(SceneShell, KeepsWhatItKnowsOfMovingInstances) {
  Scene scene = make_scene();
  const InstanceId ball = add(scene, fine_ball_, at(1.6));
  SceneProbe probe = make_probe(scene);
  SceneShellState kept = state();
  std::size_t queries = 0, queries_anew = 0;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(scene.set_pose(ball, turned(1.6 - 0.002 * i, 0.003 * i)));
    const Wrench wrench = shell_.wrench(probe, kept, {}, options_);
    SceneShellState fresh = state();
    const Wrench anew = shell_.wrench(probe, fresh, {}, options_);
    EXPECT_EQ(bits_of(wrench), bits_of(anew)) << i;
    queries += wrench.queries;
    queries_anew += anew.queries;
  }
  EXPECT_GT(queries_anew, 2 * queries);
  EXPECT_GT(shell_.wrench(probe, kept, {}, options_).contacts, 0u);
}

TEST_F(SceneShell, SharesItsWorkAmongInstances) {
  Scene scene = make_scene();
  add(scene, ball_, at(1.3));
  add(scene, ball_, at(-1.3));
  SceneProbe probe = make_probe(scene);
  SceneShellState states = state();
  for (const std::uint32_t work : {0u, 1u, 100u, 1000u, 5000u}) {
    ShellOptions limited = options_;
    limited.max_work = work;
    states.reset();
    const Wrench wrench = shell_.wrench(probe, states, {}, limited);
    EXPECT_LE(wrench.work, work);
    EXPECT_GE(wrench.queries, 2u);
    EXPECT_EQ(wrench.status == Status::kExact, wrench.undecided == 0);
    EXPECT_EQ(wrench.status == Status::kDegraded, work < 5000);
  }
}

TEST_F(SceneShell, RefusesBadArguments) {
  Scene scene = make_scene();
  const InstanceId ball = add(scene, ball_, at(1.4));
  SceneProbe probe = make_probe(scene);
  SceneShellState states = state();
  EXPECT_EQ(SceneShellState::create(shell_, 0).error().code, ErrorCode::kBadArgument);
  EXPECT_EQ(SceneShellState::create(shell_, 5000).error().code, ErrorCode::kBadArgument);
  EXPECT_EQ(shell_.wrench(probe, states, {{2, 0, 0, 0}, {}}, options_).status, Status::kBadQuery);
  EXPECT_EQ(shell_.wrench(probe, states, {}, {.stiffness = -1}).status, Status::kBadQuery);
  // Of an instance so far away that the tool is not in its range, nothing is known.
  ASSERT_TRUE(scene.set_pose(ball, {{}, {0x1p500, 0, 0}}));
  const Wrench far = shell_.wrench(probe, states, {{}, {-0x1p500, 0, 0}},
                                   {.margin = 0x1p503, .depth_rule = DepthRule::kTwoSided});
  EXPECT_EQ(far.status, Status::kDegraded);
  EXPECT_TRUE(std::isinf(far.force_error));
}

}  // namespace
}  // namespace planetree::query
