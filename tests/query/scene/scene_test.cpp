#include "planetree/scene.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "query/scene/instance_table.h"
#include "tests/query/answer_bits.h"
#include "tests/query/eventually.h"
#include "tests/query/scene/scene_fixture.h"

namespace planetree::query {
namespace {

using SceneTest = SceneFixture;

std::vector<QueryOptions> many_options() {
  std::vector<QueryOptions> all;
  for (const std::uint32_t parts : {0u, kDistance, kSide, kDistance | kSide, kAllParts})
    for (const double max_error : {0.0, 0.01})
      for (const double max_distance : {0.0, 0.1, std::numeric_limits<double>::infinity()})
        for (const NormalRule rule : {NormalRule::kOutward, NormalRule::kTowardQuery}) {
          QueryOptions options{.parts = parts, .normal_rule = rule};
          options.max_error = max_error;
          options.max_distance = max_distance;
          all.push_back(options);
        }
  return all;
}

TEST_F(SceneTest, OfOneStillInstanceAnswersAsItsModel) {
  const Model model = fine_ball_.open();
  Scene scene = make_scene();
  const InstanceId id = add(scene, fine_ball_);
  Probe alone = query::make_probe(model);
  SceneProbe probe = make_probe(scene);
  for (const QueryOptions& options : many_options()) {
    for (const Vec3& query : random_queries(40, -1.3, 1.3)) {
      const SceneClosestPoint answer = probe.closest_point(query, options);
      EXPECT_EQ(bits_of(answer), bits_of(alone.closest_point(query, options)));
      if (answer.status == Status::kExact && (options.parts & kDistance) != 0) {
        EXPECT_EQ(answer.instance, id);
      }
      const SceneContainment side = probe.contains(query, options);
      const Containment side_alone = alone.contains(query, options);
      EXPECT_EQ(side.side, side_alone.side);
      EXPECT_EQ(side.status, side_alone.status);
    }
  }
}

TEST_F(SceneTest, RefusesBadQueriesAsAModelDoes) {
  Scene scene = make_scene();
  const InstanceId id = add(scene, ball_);
  SceneProbe probe = make_probe(scene);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(probe.closest_point({nan, 0, 0}).status, Status::kBadQuery);
  EXPECT_EQ(probe.contains({0, nan, 0}).status, Status::kBadQuery);
  EXPECT_EQ(probe.closest_point({0, 0, 0}, {.max_error = -1}).status, Status::kBadQuery);
  EXPECT_EQ(probe.closest_point({1e200, 0, 0}).status, Status::kExact);
  ASSERT_TRUE(scene.set_pose(id, at(1)));
  EXPECT_EQ(probe.closest_point({1e200, 0, 0}).status, Status::kBadQuery);
  EXPECT_EQ(probe.closest_point({1e150, 0, 0}).status, Status::kExact);
}

TEST_F(SceneTest, WithoutInstancesHasNoSurface) {
  const Scene scene = make_scene();
  SceneProbe probe = make_probe(scene);
  const SceneClosestPoint answer = probe.closest_point({1, 2, 3});
  EXPECT_EQ(answer.status, Status::kBeyondMaxDistance);
  EXPECT_EQ(answer.instance, kNoInstance);
  EXPECT_EQ(probe.contains({1, 2, 3}).side, Side::kOutside);
}

TEST_F(SceneTest, FindsTheNearestOfManyInstances) {
  Scene scene = make_scene();
  std::vector<InstanceId> ids;
  for (int i = 0; i < 30; ++i) ids.push_back(add(scene, i % 2 ? ball_ : fine_ball_, at(3.0 * i)));
  EXPECT_EQ(scene.stats().instances, 30u);
  EXPECT_EQ(scene.stats().models, 2u);
  SceneProbe probe = make_probe(scene);
  for (int i = 0; i < 30; ++i) {
    const SceneClosestPoint answer = probe.closest_point({3.0 * i + 0.1, 0, 1.3});
    EXPECT_EQ(answer.instance, ids[static_cast<std::size_t>(i)]);
    EXPECT_EQ(answer.status, Status::kExact);
    EXPECT_NEAR(answer.distance, std::hypot(0.1, 1.3) - 1, 0.01);
    EXPECT_NEAR(answer.point.x, 3.0 * i, 0.1);
    EXPECT_GT(answer.normal.z, 0.9);
    EXPECT_EQ(answer.side, Side::kOutside);
    EXPECT_EQ(probe.contains({3.0 * i, 0.2, 0}).instance, ids[static_cast<std::size_t>(i)]);
  }
  EXPECT_EQ(probe.contains({1.5, 0, 0}).side, Side::kOutside);
}

TEST_F(SceneTest, GivesTheFirstAddedOfEqualInstances) {
  Scene scene = make_scene();
  const InstanceId far = add(scene, ball_, at(9));
  const InstanceId first = add(scene, ball_, at(1));
  add(scene, ball_, at(1));
  SceneProbe probe = make_probe(scene);
  EXPECT_EQ(probe.closest_point({1, 0, 1.2}).instance, first);
  EXPECT_EQ(probe.contains({1, 0, 0}).instance, first);
  EXPECT_EQ(probe.closest_point({9, 0, 1.2}).instance, far);
}

// Both scenes have the same models in the same places, added in opposite orders.
TEST_F(SceneTest, AnswersDoNotDependOnTheOrderOfAdding) {
  const std::vector<std::pair<const SampleModel*, Pose>> all = {{&ball_, turned(0, 0.3)},
                                                                {&fine_ball_, turned(0.7, -0.8)},
                                                                {&ball_, turned(2.1, 0.5)},
                                                                {&fine_ball_, at(1.1, 1.2)}};
  Scene one = make_scene(), other = make_scene();
  for (std::size_t i = 0; i < all.size(); ++i) {
    add(one, *all[i].first, all[i].second);
    add(other, *all[all.size() - 1 - i].first, all[all.size() - 1 - i].second);
  }
  SceneProbe probe = make_probe(one), other_probe = make_probe(other);
  std::size_t exact = 0;
  for (const Vec3& query : random_queries(300, -2, 4)) {
    const SceneClosestPoint answer = probe.closest_point(query);
    exact += answer.status == Status::kExact;
    EXPECT_EQ(bits_of(answer), bits_of(other_probe.closest_point(query)));
    EXPECT_EQ(probe.contains(query).side, other_probe.contains(query).side);
  }
  EXPECT_GT(exact, 290u);
}

TEST_F(SceneTest, MovesAreSeenByTheNextQuery) {
  Scene scene = make_scene();
  const InstanceId ball = add(scene, ball_);
  SceneProbe probe = make_probe(scene);
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(scene.set_pose(ball, at(i)));
    EXPECT_NEAR(probe.closest_point({i + 0.01, 0, 1.5}).distance, 0.5, 0.01);
    EXPECT_EQ(probe.contains({i + 0.1, 0, 0}).side, Side::kInside);
  }
}

// The second ball is farther, but only its root is in memory: it might be the nearer one.
TEST_F(SceneTest, IsExactOnlyIfNoOtherInstanceCanBeNearer) {
  Scene scene = make_scene();
  const InstanceId known = add(scene, fine_ball_, at(0));
  SceneProbe probe = make_probe(scene);
  const Vec3 query{1, 0.3, 0};
  EXPECT_EQ(probe.closest_point(query, {.parts = kDistance}).status, Status::kExact);
  add(scene, ball_, at(2.01));
  const SceneClosestPoint now =
      probe.closest_point(query, {.parts = kDistance, .wait = Wait::kNever});
  EXPECT_EQ(now.instance, known);
  EXPECT_EQ(now.status, Status::kDegraded);
  const SceneClosestPoint then = probe.closest_point(query, {.parts = kDistance});
  EXPECT_EQ(then.instance, known);
  EXPECT_EQ(then.status, Status::kExact);
  EXPECT_LT(now.lower, then.lower);
}

// A point that a rotation brings onto the surface is on neither side for certain.
TEST_F(SceneTest, SidesNearerThanRoundingAreUnknown) {
  Scene scene = make_scene();
  add(scene, ball_, turned(5, 0.25));
  SceneProbe probe = make_probe(scene);
  const SceneClosestPoint near = probe.closest_point({5.3, 0.8, 0.7});
  const SceneClosestPoint on = probe.closest_point(near.point);
  EXPECT_LE(on.distance, 1e-14);
  EXPECT_EQ(on.side, Side::kUnknown);
  EXPECT_EQ(on.status, Status::kDegraded);
  EXPECT_EQ(probe.closest_point(near.point, {.parts = kDistance}).status, Status::kExact);
  EXPECT_EQ(probe.contains(near.point).side, Side::kUnknown);
}

TEST_F(SceneTest, RemovesInstancesAndClosesTheirFiles) {
  Scene scene = make_scene();
  const SceneStats empty = scene.stats();
  const InstanceId a = add(scene, ball_), b = add(scene, ball_, at(4)),
                   c = add(scene, fine_ball_, at(8));
  SceneProbe probe = make_probe(scene);
  EXPECT_EQ(probe.closest_point({0, 0, 2}).instance, a);
  ASSERT_TRUE(scene.remove(a));
  EXPECT_EQ(probe.closest_point({0, 0, 2}).instance, b);
  EXPECT_EQ(scene.stats().models, 2u);
  ASSERT_TRUE(scene.remove(b));
  EXPECT_EQ(scene.stats().models, 1u);
  EXPECT_EQ(probe.closest_point({0, 0, 2}).instance, c);
  const InstanceId again = add(scene, ball_);
  EXPECT_EQ(probe.closest_point({0, 0, 2}).instance, again);
  ASSERT_TRUE(scene.remove(again));
  ASSERT_TRUE(scene.remove(c));
  EXPECT_EQ(probe.closest_point({0, 0, 2}).status, Status::kBeyondMaxDistance);
  const SceneStats stats = scene.stats();
  EXPECT_EQ(stats.model_bytes, 0u);
  EXPECT_GE(stats.frames + 4, empty.frames) << "frames were not backed again";
  for (const InstanceId gone : {a, b, c, again, kNoInstance, InstanceId{77}}) {
    EXPECT_EQ(scene.remove(gone).error().code, ErrorCode::kBadArgument);
    EXPECT_EQ(scene.set_pose(gone, {}).error().code, ErrorCode::kBadArgument);
    EXPECT_EQ(scene.info(gone).error().code, ErrorCode::kBadArgument);
    EXPECT_EQ(scene.memory(gone).error().code, ErrorCode::kBadArgument);
  }
}

TEST_F(SceneTest, TakesTheFirstFreePlaceForAnInstance) {
  Scene scene = make_scene();
  std::vector<InstanceId> ids;
  const auto add_one = [&] { ids.push_back(add(scene, ball_)); };
  for (int i = 0; i < 5; ++i) add_one();
  ASSERT_TRUE(scene.remove(ids[3]));
  ASSERT_TRUE(scene.remove(ids[1]));
  for (int i = 0; i < 3; ++i) add_one();
  EXPECT_EQ(slot_of(ids[5]), 1u);
  EXPECT_EQ(slot_of(ids[6]), 3u);
  EXPECT_EQ(slot_of(ids[7]), 5u);
}

TEST_F(SceneTest, TellsWhatAModelHolds) {
  Scene scene = make_scene();
  const std::uint64_t before = scene.stats().arena_bytes;
  const InstanceId all = add(scene, fine_ball_);
  const ModelMemory memory = *scene.memory(all);
  EXPECT_EQ((*scene.info(all))->triangles, 8192u);
  EXPECT_GT(memory.side_grid, 0u);
  EXPECT_GT(memory.probes, 0u);
  EXPECT_EQ(memory.total,
            memory.directory + memory.side_grid + memory.field + memory.probes + memory.other);
  const SceneStats stats = scene.stats();
  EXPECT_EQ(stats.model_bytes, memory.total);
  EXPECT_LE(stats.arena_bytes + stats.model_bytes, before);
  EXPECT_LE(stats.arena_bytes + stats.model_bytes + stats.table_bytes, stats.budget_bytes);
}

// Without the side layer its pages are not read, and its memory is not taken.
TEST_F(SceneTest, LeavesLayersOut) {
  Scene scene = make_scene();
  const InstanceId lean = add(scene, fine_ball_, {}, kDistanceLayer);
  EXPECT_EQ(scene.memory(lean)->side_grid, 0u);
  SceneProbe probe = make_probe(scene);
  for (const Vec3& query : random_queries(200, -1.2, 1.2)) {
    EXPECT_EQ(probe.closest_point(query, {.parts = kDistance}).status, Status::kExact);
    EXPECT_EQ(probe.contains(query).status, Status::kDegraded);
    EXPECT_EQ(probe.closest_point(query).side, Side::kUnknown);
  }
  EXPECT_LE(scene.stats().pages_read, fine_ball_.page_count());
  const InstanceId whole = add(scene, fine_ball_, at(10));
  EXPECT_EQ(scene.stats().models, 2u);
  EXPECT_GT(scene.memory(whole)->total, scene.memory(lean)->total);
}

// Models that are far take no page.
TEST_F(SceneTest, AsksOnlyInstancesThatCanBeNearest) {
  Scene scene = make_scene();
  add(scene, ball_);
  SceneProbe probe = make_probe(scene);
  const std::vector<Vec3> queries = random_queries(50, -1.5, 1.5);
  const auto looked_up = [&] {
    const std::uint64_t before = scene.stats().page_hits + scene.stats().page_misses;
    for (const Vec3& query : queries) probe.closest_point(query);
    return scene.stats().page_hits + scene.stats().page_misses - before;
  };
  looked_up();  // reads the pages
  const std::uint64_t alone = looked_up();
  EXPECT_GT(alone, 0u);
  for (int i = 1; i < 100; ++i) add(scene, fine_ball_, at(5.0 * i));
  EXPECT_EQ(looked_up(), alone);
}

TEST_F(SceneTest, PrefetchesAlongTheRelativeMotion) {
  Scene scene = make_scene();
  const InstanceId ball = add(scene, fine_ball_, at(0));
  SceneProbe probe = make_probe(scene);
  probe.closest_point({0, 0, 1.1});
  // The tool stands still; the ball passes below it and comes back.
  int tick = 0;
  const auto prefetched = [&] {
    ++tick;
    const bool comes_back = tick / 100 % 2 == 1;
    const double x = 0.02 * (comes_back ? 100 - tick % 100 : tick % 100) - 1;
    EXPECT_TRUE(scene.set_pose(ball, at(x), {{comes_back ? -20.0 : 20.0, 0, 0}, {}}));
    probe.motion({0, 0, 1.1}, {0, 0, 0});
    return scene.stats().pages_prefetched > 0;
  };
  EXPECT_TRUE(eventually(prefetched));
}

}  // namespace
}  // namespace planetree::query
