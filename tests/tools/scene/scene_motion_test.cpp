#include "tools/scene/scene_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(PoseAfter, MovesTheOriginStraight) {
  InstanceDescription instance;
  instance.pose.translation = {1, 2, 3};
  instance.twist.linear = {10, 0, -4};
  const Pose pose = pose_after(instance, 0.5);
  EXPECT_EQ(pose.translation.x, 6);
  EXPECT_EQ(pose.translation.y, 2);
  EXPECT_EQ(pose.translation.z, 1);
  EXPECT_EQ(pose.rotation.w, 1);
}

// The axis is one of the world, however the instance is turned at the start.
TEST(PoseAfter, TurnsAboutAnAxisOfTheWorld) {
  InstanceDescription instance;
  instance.pose.rotation = {std::sqrt(0.5), std::sqrt(0.5), 0, 0};  // y to z
  instance.twist.angular = {0, 0, kPi};
  const Pose pose = pose_after(instance, 0.5);  // then a quarter about z: x to y
  EXPECT_NEAR(pose.rotation.w, 0.5, 1e-15);
  EXPECT_NEAR(pose.rotation.x, 0.5, 1e-15);
  EXPECT_NEAR(pose.rotation.y, 0.5, 1e-15);
  EXPECT_NEAR(pose.rotation.z, 0.5, 1e-15);
}

TEST(PoseAfter, StaysOfLengthOneForADay) {
  InstanceDescription instance;
  instance.twist.angular = {3, -4, 12};
  for (int second = 0; second < 86400; second += 60) {
    const Quaternion q = pose_after(instance, second).rotation;
    ASSERT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-14);
  }
}

class SceneMotionTest : public Command {
 protected:
  static SceneDescription description_of(const std::string& instances) {
    return *parse_scene(R"({"format": "planetree-scene", "version": 1,
                            "models": {"m": {"file": "tree.ptree"}}, "instances": )" +
                            instances + "}",
                        "");
  }
  static OpenedScene open(const SceneDescription& description) {
    SceneFailure failure;
    return *OpenedScene::open(description, "scene.json", SceneOptions{}, failure);
  }
};

TEST_F(SceneMotionTest, MovesThoseThatHaveVelocities) {
  const SceneDescription description =
      description_of(R"([{"model": "m"}, {"model": "m", "velocity": [0, 0, 1000]}])");
  OpenedScene opened = open(description);
  const SceneMotion motion(description, opened, std::chrono::milliseconds(1));
  EXPECT_FALSE(motion.moves(0));
  EXPECT_TRUE(motion.moves(1));
  EXPECT_TRUE(motion.check(1000));
  auto probe = SceneProbe::create(opened.scene);
  ASSERT_TRUE(probe);
  const ModelInfo& info = **opened.scene.info(opened.ids[0]);
  const double above = info.core_upper.z + 100;
  const Vec3 query{info.core_lower.x, info.core_lower.y, above};
  EXPECT_EQ(opened.index_of(probe->closest_point(query).instance), 0u);
  motion.begin_tick(100);
  EXPECT_EQ(opened.index_of(probe->closest_point(query).instance), 1u);
  motion.begin_tick(0);
  EXPECT_EQ(opened.index_of(probe->closest_point(query).instance), 0u);
}

TEST_F(SceneMotionTest, RefusesToLeaveTheRangeOfPoses) {
  for (const char* const velocity : {R"("velocity": [1e150, 0, 0])", R"("velocity": [0, 1e308, 0])",
                                     R"("angular_velocity": [1e308, 1e308, 0])"}) {
    const SceneDescription description =
        description_of(std::string(R"([{"model": "m"}, {"model": "m", )") + velocity + "}]");
    OpenedScene opened = open(description);
    const SceneMotion motion(description, opened, std::chrono::milliseconds(1));
    const auto checked = motion.check(10'000);
    ASSERT_FALSE(checked) << velocity;
    EXPECT_EQ(checked.error().code, ErrorCode::kBadInput);
    EXPECT_EQ(std::string(checked.error().text).find("instances[1]"), 0u);
  }
}

}  // namespace
}  // namespace planetree::tools
