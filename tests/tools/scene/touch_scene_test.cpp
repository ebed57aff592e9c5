// `planetree touch --scene`.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"
#include "tools/scene/scene_motion.h"
#include "tools/scene/scene_session.h"
#include "tools/session/ball_proxy.h"

namespace planetree::tools {
namespace {

class TouchScene : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    ASSERT_EQ(run({"generate", "statue.ply", "--triangles", "5K", "--quiet"}).status, kDone);
    ASSERT_EQ(run({"build", "statue.ply", "-o", "statue.ptree", "--quiet"}).status, kDone);
    const auto model = Model::open("statue.ptree");
    ASSERT_TRUE(model);
    lower_ = model->info().core_lower;
    upper_ = model->info().core_upper;
    across_ = std::max({upper_.x - lower_.x, upper_.y - lower_.y, upper_.z - lower_.z});
    write_scene("", "distance,side,field");
  }
  // Two statues, the second of which stands aside and moves.
  void write_scene(const std::string& velocities, const std::string& layers) const {
    write("scene.json", R"({"format": "planetree-scene", "version": 1, "memory": "24M",
      "models": {"statue": {"file": "statue.ptree", "layers": ")" +
                            layers + R"("}},
      "instances": [{"name": "left", "model": "statue"}, {"model": "statue", "translation": [)" +
                            std::to_string(2 * across_) + ", 0, 0]" + velocities + "}]}");
  }
  std::string approaching() const {
    return R"(, "velocity": [)" + std::to_string(-2 * across_) +
           R"(, 0, 0], "angular_velocity": [0, 0, 1])";
  }
  static std::vector<std::string> session(std::vector<std::string> more) {
    std::vector<std::string> words = {"touch", "--scene", "scene.json", "--seconds",
                                      "1",     "--rate",  "500"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  // The path of a session of 1000 ticks.
  std::vector<Vec3> path(TouchMotion motion) const {
    TouchArguments arguments;
    arguments.file = "scene.json";
    arguments.is_scene = true;
    arguments.seconds = 1;
    arguments.motion = motion;
    SceneFailure failure;
    const auto description = read_scene("scene.json");
    EXPECT_TRUE(description);
    const auto found = find_scene_path(arguments, *description, failure);
    EXPECT_TRUE(found) << failure.error.text;
    return *found;
  }

  Vec3 lower_, upper_;
  double across_ = 0;
};

TEST_F(TouchScene, ReportsTicksOfEachInstance) {
  const Outcome outcome = run(session({"--path", "teleport", "--json"}));
  ASSERT_EQ(outcome.status, kDone) << outcome.errors;
  const Json report = Json::parse(outcome.output);
  EXPECT_EQ(report["file"], "scene.json");
  EXPECT_EQ(report["ticks"], 500);
  EXPECT_EQ(report["budget_bytes"], 24 << 20) << "what the scene file says";
  EXPECT_LE(report["held_bytes"], report["budget_bytes"]);
  EXPECT_GE(report["pages_read"], 1);
  EXPECT_LE(report["latency_us"]["p50"], report["latency_us"]["max"]);
  ASSERT_EQ(report["instances"].size(), 2u);
  const Json &left = report["instances"][0], &right = report["instances"][1];
  EXPECT_EQ(left["name"], "left");
  EXPECT_EQ(right["model"], "statue");
  EXPECT_EQ(right["moves"], false);
  EXPECT_EQ(left["ticks"].get<int>() + right["ticks"].get<int>(), 500);
  for (const char* const key :
       {"layers", "fetch_requests", "pages_read_ahead", "page_trace_dropped", "locked_bytes"})
    EXPECT_FALSE(report.contains(key)) << key << " is not one of scenes";
}

TEST_F(TouchScene, OfOneModelWhereItIsHasThePathOfTheModel) {
  write("scene.json", R"({"format": "planetree-scene", "version": 1,
    "models": {"a": {"file": "statue.ptree"}}, "instances": [{"model": "a"}]})");
  const auto model = Model::open("statue.ptree");
  auto probe = Probe::create(*model);
  ASSERT_TRUE(probe);
  const std::vector<Vec3> of_model = touch_path(*model, *probe, TouchMotion::kGlide, 1000);
  const std::vector<Vec3> of_scene = path(TouchMotion::kGlide);
  ASSERT_EQ(of_scene.size(), of_model.size());
  for (std::size_t i = 0; i < of_model.size(); ++i) {
    ASSERT_EQ(of_scene[i].x, of_model[i].x) << i;
    ASSERT_EQ(of_scene[i].y, of_model[i].y) << i;
    ASSERT_EQ(of_scene[i].z, of_model[i].z) << i;
  }
}

TEST_F(TouchScene, ReportsAsText) {
  write_scene(approaching(), "distance,side");
  const Outcome outcome = run(session({"--memory", "16M", "--policy", "lru", "--cold"}));
  ASSERT_EQ(outcome.status, kDone) << outcome.errors;
  EXPECT_EQ(outcome.output.find("scene.json: glide, 500 ticks at 500 Hz"), 0u);
  EXPECT_NE(outcome.output.find("of a budget of 16.0 MiB"), std::string::npos);
  EXPECT_NE(outcome.output.find("2 instances, of which 1 move"), std::string::npos);
  EXPECT_NE(outcome.output.find(": nearest in "), std::string::npos);
  EXPECT_EQ(outcome.output.find("memory locked"), std::string::npos) << "a scene does not tell";
}

TEST_F(TouchScene, WritesTicksAndAPage) {
  const Outcome outcome = run(session({"--ticks", "ticks.csv", "--html", "page.html"}));
  ASSERT_EQ(outcome.status, kDone) << outcome.errors;
  const std::vector<std::string> rows = lines_of(text_of("ticks.csv"));
  ASSERT_EQ(rows.size(), 501u);
  EXPECT_EQ(rows[0], "tick,x,y,z,latency_us,query_us,width,side,status,instance");
  EXPECT_EQ(std::count(rows[500].begin(), rows[500].end(), ','), 9);
  const std::string page = text_of("page.html");
  EXPECT_NE(page.find("planetree touch --scene scene.json --seconds 1 --rate 500 --memory "
                      "25165824 --ticks ticks.csv --html page.html --force"),
            std::string::npos);
  EXPECT_EQ(run(session({"--html", "statue.ptree", "--force"})).status, kCommandLineAtFault)
      << "a model of the scene is no output";
}

TEST_F(TouchScene, AsksForTheDistanceAloneWhereSidesAreNotTold) {
  write_scene("", "distance");
  const Outcome outcome = run(session({"--json", "--ticks", "ticks.csv"}));
  ASSERT_EQ(outcome.status, kDone) << outcome.errors;
  const std::vector<std::string> rows = lines_of(text_of("ticks.csv"));
  EXPECT_NE(rows.back().find(",unknown,exact,"), std::string::npos) << rows.back();
}

TEST_F(TouchScene, PathFollowsWhatMoves) {
  write_scene(approaching(), "distance,side");
  const std::vector<Vec3> tips = path(TouchMotion::kTeleport), again = path(TouchMotion::kTeleport);
  ASSERT_EQ(tips.size(), 1000u);
  for (std::size_t i = 0; i < tips.size(); ++i) ASSERT_EQ(tips[i].x, again[i].x) << i;
  const auto description = read_scene("scene.json");
  SceneFailure failure;
  auto opened = OpenedScene::open(*description, "scene.json", SceneOptions{}, failure);
  ASSERT_TRUE(opened);
  const SceneMotion motion(*description, *opened, std::chrono::milliseconds(1));
  auto probe = SceneProbe::create(opened->scene);
  ASSERT_TRUE(probe);
  std::size_t on_second = 0;
  for (std::size_t tick = 0; tick < tips.size(); tick += 100) {
    motion.begin_tick(tick);
    const SceneClosestPoint nearest = probe->closest_point(tips[tick]);
    EXPECT_LT(nearest.distance, 1e-9 * across_) << "a tip jumps to where the surface then is";
    on_second += opened->index_of(nearest.instance);
  }
  EXPECT_GT(on_second, 0u);
}

// A ball that rests in the way of an instance is pushed, and stays outside.
TEST_F(TouchScene, BallGivesWayToWhatMoves) {
  write_scene(approaching(), "distance,side,field");
  const auto description = read_scene("scene.json");
  SceneFailure failure;
  auto opened = OpenedScene::open(*description, "scene.json", SceneOptions{}, failure);
  ASSERT_TRUE(opened);
  const SceneMotion motion(*description, *opened, std::chrono::milliseconds(1));
  auto probe = SceneProbe::create(opened->scene);
  ASSERT_TRUE(probe);
  const double middle_y = 0.5 * (lower_.y + upper_.y), middle_z = 0.5 * (lower_.z + upper_.z);
  const Vec3 rest{upper_.x + 0.2 * across_, middle_y, middle_z};
  BallProxy ball(0.01 * across_, 1e-5 * across_);
  ball.put(*probe, rest);
  int touching = 0;
  // Later it would be squeezed between both instances.
  for (std::size_t tick = 0; tick < 450; ++tick) {
    motion.begin_tick(tick);
    const BallProxy::Tick now = ball.follow_among_moving(*probe, rest, {});
    EXPECT_EQ(now.status, Status::kExact);
    EXPECT_TRUE(!now.touches || opened->index_of(now.instance) == 1);
    touching += now.touches;
    const SceneClosestPoint nearest = probe->closest_point(ball.centre());
    ASSERT_EQ(nearest.side, Side::kOutside) << tick;
    ASSERT_GE(nearest.distance, ball.radius()) << tick;
  }
  EXPECT_GT(touching, 10);
}

TEST_F(TouchScene, TouchesWithABall) {
  write_scene(approaching(), "distance,side,field");
  const Outcome outcome =
      run(session({"--tool", "sphere", "--radius", std::to_string(0.01 * across_), "--path",
                   "scratch", "--json"}));
  ASSERT_EQ(outcome.status, kDone) << outcome.errors;
  const Json report = Json::parse(outcome.output);
  EXPECT_EQ(report["tool"], "sphere");
  EXPECT_EQ(report["instances"][1]["moves"], true);
  EXPECT_GT(report["touching"], 0);
  EXPECT_EQ(report["instances"][0]["ticks"].get<int>() + report["instances"][1]["ticks"].get<int>(),
            report["touching"]);
}

TEST_F(TouchScene, RefusesWhatScenesDoNotHave) {
  const auto refused = [](std::vector<std::string> more, const std::string& remedy) {
    const Outcome outcome = run(session(std::move(more)));
    EXPECT_EQ(outcome.status, kCommandLineAtFault);
    EXPECT_NE(outcome.errors.find(remedy), std::string::npos) << outcome.errors;
  };
  refused({"--trace", "t.trace"}, "omit --trace");
  refused({"--deterministic"}, "omit --deterministic");
  refused({"--latency", "85us"}, "omit --deterministic and --latency");
  refused({"--read-ahead"}, "omit --read-ahead");
  refused({"--layers", "distance"}, "write them there");
  refused({"statue.ptree"}, "a FILE or a --scene");
  const Outcome nothing = run({"touch"});
  EXPECT_EQ(nothing.status, kCommandLineAtFault);
  EXPECT_NE(nothing.errors.find("give a FILE"), std::string::npos) << nothing.errors;
}

TEST_F(TouchScene, SaysWhichFileFails) {
  write("scene.json", R"({"format": "planetree-scene", "version": 1,
    "models": {"a": {"file": "lacking.ptree"}}, "instances": [{"model": "a"}]})");
  EXPECT_NE(run(session({})).errors.find("lacking.ptree: "), std::string::npos);
  write_scene(R"(, "velocity": [1e151, 0, 0])", "distance");
  const Outcome far = run(session({}));
  EXPECT_EQ(far.status, kDataAtFault);
  EXPECT_NE(far.errors.find("scene.json: instances[1] moves beyond"), std::string::npos)
      << far.errors;
}

}  // namespace
}  // namespace planetree::tools
