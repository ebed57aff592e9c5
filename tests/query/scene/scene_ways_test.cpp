// Rays, contacts and moving balls in scenes.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "planetree/scene.h"
#include "tests/query/answer_bits.h"
#include "tests/query/scene/scene_fixture.h"

namespace planetree::query {
namespace {

using SceneWays = SceneFixture;

TEST_F(SceneWays, OfOneStillInstanceIsTouchedAsItsModel) {
  const Model model = fine_ball_.open();
  Scene scene = make_scene();
  add(scene, fine_ball_);
  Probe alone = query::make_probe(model);
  SceneProbe probe = make_probe(scene);
  const std::vector<Vec3> points = random_queries(300, -2, 2);
  std::size_t touched = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Sweep sweep{points[i - 1], points[i], i % 3 == 0 ? 0 : 0.05};
    QueryOptions options;
    if (i % 4 == 0) options.max_distance = 0.7;
    const SceneFirstContact contact = probe.first_contact(sweep, i % 2 ? 0.5 : 0, options);
    EXPECT_EQ(bits_of(contact), bits_of(alone.first_contact(sweep, options))) << i;
    EXPECT_EQ(contact.instance != kNoInstance, contact.t <= 1);
    touched += contact.t <= 1;
  }
  EXPECT_GT(touched, 50u);
}

TEST_F(SceneWays, OfOneStillInstanceIsHitAndTouchedInPlacesAsItsModel) {
  const Model model = fine_ball_.open();
  Scene scene = make_scene();
  const InstanceId ball = add(scene, fine_ball_);
  Probe alone = query::make_probe(model);
  SceneProbe probe = make_probe(scene);
  const std::vector<Vec3> points = random_queries(200, -2, 2);
  std::vector<SceneClosestPoint> found(20);
  std::vector<ClosestPoint> found_alone(20);
  std::size_t hits = 0, contacts = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    QueryOptions options;
    if (i % 4 == 0) options.max_distance = 0.7;
    const Ray ray{points[i - 1], points[i]};
    const SceneRayHit hit = probe.first_hit(ray, options);
    EXPECT_EQ(bits_of(hit), bits_of(alone.first_hit(ray, options)));
    EXPECT_EQ(hit.instance != kNoInstance, hit.t < 1e300);
    hits += hit.instance == ball;
    const Found set = probe.contacts(points[i], 1.5, found, options);
    const Found set_alone = alone.contacts(points[i], 1.5, found_alone, options);
    ASSERT_EQ(set.count, set_alone.count);
    EXPECT_EQ(set.complete, set_alone.complete);
    for (std::size_t k = 0; k < set.count; ++k)
      EXPECT_EQ(bits_of(found[k]), bits_of(found_alone[k]));
    contacts += set.count;
  }
  EXPECT_GT(hits, 20u);
  EXPECT_GT(contacts, 50u);
}

TEST_F(SceneWays, FindsTheContactsOfAllInstances) {
  SceneOptions options = small_options();
  options.max_contacts = 3;
  Scene scene = make_scene(options);
  const InstanceId left = add(scene, ball_, at(-1.5)), right = add(scene, ball_, at(1.5)),
                   above = add(scene, fine_ball_, at(0, 2)), far = add(scene, ball_, at(9));
  SceneProbe probe = make_probe(scene);
  std::vector<SceneClosestPoint> found(4);
  const Found two = probe.contacts({0.1, 0, 0}, 0.7, found);
  EXPECT_EQ(two.count, 2u);
  EXPECT_TRUE(two.complete);
  EXPECT_EQ(found[0].instance, right);
  EXPECT_EQ(found[1].instance, left);
  EXPECT_LT(found[0].normal.x, -0.9);
  EXPECT_GT(found[1].normal.x, 0.9);
  const Found three = probe.contacts({0.1, 0, 0}, 1.2, found);
  EXPECT_EQ(three.count, 3u);
  EXPECT_EQ(found[2].instance, above);
  EXPECT_FALSE(probe.contacts({0.1, 0, 0}, 100, found).complete) << "there is room for three";
  EXPECT_EQ(probe.contacts({0.1, 0, 0}, 0.7, std::span(found).first(1)).count, 1u);
  EXPECT_EQ(found[0].instance, right);
  EXPECT_FALSE(probe.contacts({0.1, 0, 0}, 0.7, std::span(found).first(1)).complete);
  EXPECT_EQ(probe.contacts({0.1, 0, 0}, -1, found).count, 0u);
  ASSERT_TRUE(scene.remove(far));
}

TEST_F(SceneWays, RaysHitTheFirstInstanceOnTheirWay) {
  Scene scene = make_scene();
  const InstanceId near = add(scene, ball_, turned(3, 0.4)), far = add(scene, ball_, at(9));
  SceneProbe probe = make_probe(scene);
  const SceneRayHit hit = probe.first_hit({{0, 0.1, 0.1}, {2, 0, 0}});
  EXPECT_EQ(hit.instance, near);
  EXPECT_EQ(hit.status, Status::kExact);
  EXPECT_NEAR(hit.t, 1, 0.05);
  EXPECT_NEAR(hit.point.x, 2, 0.1);
  EXPECT_LT(hit.normal.x, -0.9);
  EXPECT_TRUE(hit.entering);
  EXPECT_LE(hit.t_lower, hit.t);
  EXPECT_GE(hit.t_upper, hit.t);
  EXPECT_LE(hit.t_upper - hit.t_lower, 1e-12);
  EXPECT_EQ(probe.first_hit({{12, 0.1, 0.1}, {-1, 0, 0}}).instance, far);
  EXPECT_EQ(probe.first_hit({{6, 0.1, 0.1}, {1, 0, 0}}).instance, far);
  EXPECT_EQ(probe.first_hit({{0, 0.1, 0.1}, {2, 0, 0}, 2.5}).instance, far);
  const SceneRayHit none = probe.first_hit({{0, 5, 0}, {1, 0, 0}});
  EXPECT_EQ(none.instance, kNoInstance);
  EXPECT_EQ(none.status, Status::kExact);
  EXPECT_EQ(none.t_lower, std::numeric_limits<double>::infinity());
  const SceneRayHit beyond = probe.first_hit({{0, 0.1, 0.1}, {2, 0, 0}}, {.max_distance = 1});
  EXPECT_EQ(beyond.status, Status::kBeyondMaxDistance);
  EXPECT_NEAR(beyond.t_lower, 0.5, 1e-12);
  EXPECT_EQ(probe.first_hit({{0, 0, 0}, {0, 0, 0}}).status, Status::kBadQuery);
  EXPECT_EQ(probe.first_hit({{0, 0, 0}, {1e-150, 0, 0}}).status, Status::kBadQuery);
}

// The last one added has the slot of the first one, which is gone.
TEST_F(SceneWays, GiveTheFirstAddedOfEqualInstances) {
  Scene scene = make_scene();
  const InstanceId gone = add(scene, ball_, at(9));
  const InstanceId first = add(scene, ball_, turned(3, 0.4));
  add(scene, ball_, turned(3, 0.4));
  ASSERT_TRUE(scene.remove(gone));
  add(scene, ball_, turned(3, 0.4));
  SceneProbe probe = make_probe(scene);
  EXPECT_EQ(probe.first_hit({{0, 0.1, 0.1}, {1, 0, 0}}).instance, first);
  EXPECT_EQ(probe.first_contact({{0, 0.1, 0.1}, {4, 0.1, 0.1}, 0.1}).instance, first);
  std::vector<SceneClosestPoint> found(3);
  EXPECT_EQ(probe.contacts({1.5, 0.3, -0.2}, 0.6, found).count, 3u);
  EXPECT_EQ(found[0].instance, first);
  EXPECT_TRUE(std::ranges::is_sorted(found, {}, &SceneClosestPoint::instance));
}

// The ball of radius 1 comes to a tool of radius 0.5 that stands still, or moves beside it.
TEST_F(SceneWays, MovingInstancesTouchTheTool) {
  Scene scene = make_scene();
  const InstanceId ball = add(scene, ball_, at(5));
  SceneProbe probe = make_probe(scene);
  const Sweep still{{0, 0, 0}, {0, 0, 0}, 0.5};
  EXPECT_TRUE(probe.first_contact(still, 1).free);
  ASSERT_TRUE(scene.set_pose(ball, at(5), {{-10, 0, 0}, {}}));
  EXPECT_TRUE(probe.first_contact(still).free) << "with 0 seconds instances stand still";
  const SceneFirstContact contact = probe.first_contact(still, 1);
  EXPECT_EQ(contact.instance, ball);
  EXPECT_NEAR(contact.t, 0.35, 0.01);
  EXPECT_LE(contact.t_lower, contact.t);
  EXPECT_GE(contact.t_upper, contact.t);
  EXPECT_LE(contact.t_upper - contact.t_lower, 1e-9);
  EXPECT_NEAR(contact.at.point.x, 0.5, 0.01);
  EXPECT_LT(contact.at.normal.x, -0.99);
  EXPECT_TRUE(probe.first_contact(still, 0.3).free);
  EXPECT_TRUE(probe.first_contact({{0, 0, 0}, {-10, 0, 0}, 0.5}, 1).free) << "it flees as fast";
  // A turn of more than a radian is too much.
  ASSERT_TRUE(scene.set_pose(ball, at(1), {{}, {0, 0, 2}}));
  const SceneFirstContact unknown = probe.first_contact(still, 1);
  EXPECT_EQ(unknown.status, Status::kDegraded);
  EXPECT_EQ(unknown.t_lower, 0);
  EXPECT_FALSE(unknown.free);
  EXPECT_EQ(probe.first_contact(still, -1).status, Status::kBadQuery);
}

}  // namespace
}  // namespace planetree::query
