#include "tools/session/ball_proxy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "tests/tools/cli/command_fixture.h"
#include "tools/session/session_path.h"

namespace planetree::tools {
namespace {

constexpr double kRadius = 0.05, kGap = 1e-5;

class BallProxyTest : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    ASSERT_EQ(run({"generate", "statue.ply", "--triangles", "20K", "--quiet"}).status, kDone);
    ASSERT_EQ(run({"build", "statue.ply", "-o", "statue.ptree", "--quiet"}).status, kDone);
    auto model = Model::open("statue.ptree");
    ASSERT_TRUE(model);
    model_.emplace(std::move(*model));
    auto probe = Probe::create(*model_);
    ASSERT_TRUE(probe);
    probe_.emplace(std::move(*probe));
  }
  double diagonal() const {
    const ModelInfo& info = model_->info();
    return std::hypot(info.box_upper.x - info.box_lower.x, info.box_upper.y - info.box_lower.y,
                      info.box_upper.z - info.box_lower.z);
  }
  // Whether the ball is outside and clear of the surface.
  bool is_free(const BallProxy& ball) {
    const ClosestPoint nearest = probe_->closest_point(ball.centre());
    return nearest.side == Side::kOutside && nearest.distance > ball.radius();
  }

  std::optional<Model> model_;
  std::optional<Probe> probe_;
};

TEST_F(BallProxyTest, NeverEntersTheSurface) {
  const double size = diagonal();
  int touching = 0;
  for (const TouchMotion motion : {TouchMotion::kScratch, TouchMotion::kTeleport}) {
    const std::vector<Vec3> path = touch_path(*model_, *probe_, motion, 1000, 3);
    BallProxy ball(kRadius * size, kGap * size);
    ball.put(*probe_, path.front());
    ASSERT_TRUE(is_free(ball));
    for (const Vec3& device : path) {
      const BallProxy::Tick tick = ball.follow(*probe_, device, {});
      touching += tick.touches;
      EXPECT_EQ(tick.status, Status::kExact);
      ASSERT_TRUE(is_free(ball));
    }
  }
  EXPECT_GT(touching, 1000);
}

TEST_F(BallProxyTest, ReachesWhatIsFreeAndSlidesAlongTheRest) {
  const double size = diagonal();
  const Vec3 high{0, 0, 2 * size};
  BallProxy ball(kRadius * size, kGap * size);
  ball.put(*probe_, high);
  const Vec3 aside{size, 0, 2 * size};
  EXPECT_FALSE(ball.follow(*probe_, aside, {}).touches);
  EXPECT_EQ(ball.centre().x, aside.x);
  // From above to the other side: the surface is in between.
  ball.put(*probe_, high);
  const BallProxy::Tick tick = ball.follow(*probe_, {0.2 * size, 0, -2 * size}, {});
  EXPECT_TRUE(tick.touches);
  EXPECT_GT(ball.centre().z, 0);
  EXPECT_TRUE(is_free(ball));
}

}  // namespace
}  // namespace planetree::tools
