#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/query/scene/scene_fixture.h"

namespace planetree::query {
namespace {

using SceneErrors = SceneFixture;

void expect_refused(const SceneOptions& options, ErrorCode code, const char* word) {
  const auto scene = Scene::create(options);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, code);
  EXPECT_NE(std::string(scene.error().text).find(word), std::string::npos) << scene.error().text;
}

TEST_F(SceneErrors, RefuseOptionsOutOfRange) {
  const auto changed = [](auto change) {
    SceneOptions options = small_options();
    change(options);
    return options;
  };
  using O = SceneOptions;
  const ErrorCode bad = ErrorCode::kBadArgument;
  expect_refused(changed([](O& o) { o.fetch_threads = 0; }), bad, "fetch_threads");
  expect_refused(changed([](O& o) { o.fetch_threads = 65; }), bad, "fetch_threads");
  expect_refused(changed([](O& o) { o.max_probes = 0; }), bad, "max_probes");
  expect_refused(changed([](O& o) { o.max_probes = 1025; }), bad, "max_probes");
  expect_refused(changed([](O& o) { o.max_instances = 0; }), bad, "max_instances");
  expect_refused(changed([](O& o) { o.max_instances = (1U << 20) + 1; }), bad, "max_instances");
  expect_refused(changed([](O& o) { o.max_page_bytes = 2048; }), bad, "max_page_bytes");
  expect_refused(changed([](O& o) { o.max_page_bytes = 5000; }), bad, "max_page_bytes");
  expect_refused(changed([](O& o) { o.policy = static_cast<EvictionPolicy>(9); }), bad, "policy");
  expect_refused(changed([](O& o) { o.memory_budget_bytes = 1000; }), ErrorCode::kNoMemory,
                 "at least");
}

TEST_F(SceneErrors, NameTheBudgetThatSuffices) {
  SceneOptions options = small_options();
  options.memory_budget_bytes = 1000;
  const auto refused = Scene::create(options);
  ASSERT_FALSE(refused);
  const std::string text = refused.error().text;
  options.memory_budget_bytes = std::stoull(text.substr(text.find("at least ") + 9));
  Scene scene = make_scene(options);
  EXPECT_LE(scene.stats().arena_bytes + scene.stats().table_bytes, options.memory_budget_bytes);
  const auto added = scene.add(fine_ball_.path());
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().code, ErrorCode::kNoMemory);
  const std::string lacking = added.error().text;
  options.memory_budget_bytes += std::stoull(lacking);
  Scene larger = make_scene(options);
  EXPECT_TRUE(larger.add(fine_ball_.path())) << "what the text says is lacking does not suffice";
}

TEST_F(SceneErrors, RefuseFilesThatDoNotFit) {
  const SampleModel wide = SampleModel::masked(octree::sphere(3), 8192);
  Scene scene = make_scene();
  const auto added = scene.add(wide.path());
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().code, ErrorCode::kBadArgument);
  EXPECT_NE(std::string(added.error().text).find("max_page_bytes of at least 8192"),
            std::string::npos);
  EXPECT_EQ(scene.add("/no/such/file").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(scene.add(ball_.path(), {}, 64).error().code, ErrorCode::kBadArgument);
  EXPECT_EQ(scene.stats().models, 0u);
  EXPECT_EQ(scene.stats().model_bytes, 0u);
}

TEST_F(SceneErrors, RefusePosesThatAreNotValid) {
  Scene scene = make_scene();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(scene.add(ball_.path(), at(nan)).error().code, ErrorCode::kBadArgument);
  EXPECT_EQ(scene.stats().models, 0u) << "the file stays open";
  const InstanceId ball = add(scene, ball_);
  for (const Pose& pose : {at(nan), at(std::numeric_limits<double>::infinity()), at(1e300),
                           Pose{{2, 0, 0, 0}, {}}, Pose{{0, 0, 0, 0}, {}}})
    EXPECT_EQ(scene.set_pose(ball, pose).error().code, ErrorCode::kBadArgument);
  EXPECT_EQ(scene.set_pose(ball, {}, {{nan, 0, 0}, {}}).error().code, ErrorCode::kBadArgument);
  SceneProbe probe = make_probe(scene);
  EXPECT_NEAR(probe.closest_point({0, 0, 2}).distance, 1, 0.01);
}

TEST_F(SceneErrors, RefuseMoreThanWasAskedFor) {
  SceneOptions options = small_options();
  options.max_instances = 3;
  Scene scene = make_scene(options);
  for (int i = 0; i < 3; ++i) add(scene, ball_, at(i));
  EXPECT_NE(std::string(scene.add(ball_.path()).error().text).find("larger max_instances"),
            std::string::npos);
  const SceneProbe one = make_probe(scene), two = make_probe(scene);
  EXPECT_EQ(SceneProbe::create(scene).error().code, ErrorCode::kBadArgument);
}

}  // namespace
}  // namespace planetree::query
