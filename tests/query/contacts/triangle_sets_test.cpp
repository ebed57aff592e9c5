#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "planetree/probe.h"
#include "tests/cache/allocation_count.h"
#include "tests/query/answer_bits.h"
#include "tests/query/eventually.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A sphere of 8,192 triangles.
class TriangleSets : public testing::Test {
 protected:
  const SampleModel sample_ = SampleModel::masked(octree::sphere(5));
  std::vector<ClosestPoint> found_ = std::vector<ClosestPoint>(64);
};

TEST_F(TriangleSets, BeginWithTheNearestTriangle) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  for (const Vec3& query : random_queries(200, -1.5, 1.5)) {
    const ClosestPoint nearest = probe.closest_point(query);
    const Found set = probe.nearest_triangles(query, found_);
    ASSERT_TRUE(set.complete);
    ASSERT_EQ(set.count, found_.size());
    EXPECT_EQ(found_[0].triangle, nearest.triangle);
    EXPECT_EQ(found_[0].distance, nearest.distance);
    EXPECT_EQ(found_[0].feature, nearest.feature);
    for (const ClosestPoint& answer : found_) {
      EXPECT_EQ(answer.side, nearest.side);
      EXPECT_EQ(answer.status, Status::kExact);
      // The sphere's triangles face outward.
      const Vec3& n = answer.normal;
      const Vec3& p = answer.point;
      EXPECT_GT(n.x * p.x + n.y * p.y + n.z * p.z, 0.9);
    }
  }
}

TEST_F(TriangleSets, AreTheSameInLittleMemory) {
  const Model large = sample_.open(), small = sample_.open(sample_.min_budget());
  Probe of_large = make_probe(large), of_small = make_probe(small);
  std::vector<ClosestPoint> other(found_.size());
  for (const Vec3& query : random_queries(50, -1.5, 1.5)) {
    const Found set = of_large.triangles_within(query, 0.4, found_);
    const Found again = of_small.triangles_within(query, 0.4, other);
    ASSERT_EQ(again.count, set.count);
    EXPECT_EQ(again.complete, set.complete);
    for (std::size_t i = 0; i < set.count; ++i) EXPECT_EQ(bits_of(other[i]), bits_of(found_[i]));
  }
}

TEST_F(TriangleSets, ComeWithoutWaitingOnceThePagesAreThere) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  const QueryOptions options{.wait = Wait::kNever};
  int incomplete = 0;
  for (const Vec3& query : random_queries(10, -1.2, 1.2)) {
    Found set = probe.nearest_triangles(query, found_, options);
    incomplete += !set.complete;
    for (std::size_t i = 0; i < set.count; ++i) EXPECT_NE(found_[i].status, Status::kBadQuery);
    EXPECT_TRUE(eventually([&] {
      set = probe.nearest_triangles(query, found_, options);
      return set.complete && found_[0].status == Status::kExact;
    }));
    std::vector<ClosestPoint> expected(found_.size());
    const Model other = sample_.open();
    ASSERT_TRUE(make_probe(other).nearest_triangles(query, expected).complete);
    for (std::size_t i = 0; i < found_.size(); ++i)
      EXPECT_EQ(bits_of(found_[i]), bits_of(expected[i]));
  }
  EXPECT_GT(incomplete, 3);
}

TEST_F(TriangleSets, WithinARadiusComeWithoutWaitingToo) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  found_.resize(400);
  EXPECT_TRUE(eventually([&] {
    const Found set = probe.triangles_within({1, 0, 0}, 0.1, found_, {.wait = Wait::kNever});
    return set.complete && set.count > 10;
  }));
}

TEST_F(TriangleSets, OfABoxAreSortedFromItsCentre) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  const Box box{{0.7, -0.2, -0.1}, {1.3, 0.2, 0.1}};
  found_.resize(2000);
  const Found set = probe.triangles_within(box, found_);
  ASSERT_TRUE(set.complete);
  ASSERT_GT(set.count, 50u);
  ASSERT_LT(set.count, found_.size());
  // They are among those that the ball about the box meets, with the same bits.
  std::vector<ClosestPoint> ball(found_.size());
  const Found about = probe.triangles_within({1, 0, 0}, 0.4, ball);
  ASSERT_TRUE(about.complete);
  std::size_t at = 0;
  for (std::size_t i = 0; i < set.count; ++i) {
    while (at < about.count && ball[at].triangle != found_[i].triangle) ++at;
    ASSERT_LT(at, about.count);
    EXPECT_EQ(bits_of(ball[at]), bits_of(found_[i]));
  }
  const Found few = probe.triangles_within(box, std::span(ball).first(7));
  EXPECT_EQ(few.count, 7u);
  EXPECT_FALSE(few.complete);
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(bits_of(ball[i]), bits_of(found_[i]));
  EXPECT_TRUE(probe.triangles_within(Box{{2, 2, 2}, {3, 3, 3}}, found_).complete);
  EXPECT_EQ(probe.triangles_within(Box{{1, 0, 0}, {0, 1, 1}}, found_).count, 0u);
  EXPECT_FALSE(probe.triangles_within(Box{{0, 0, 0}, {kInfinity, 1, 1}}, found_).complete);
  EXPECT_FALSE(probe.triangles_within(box, found_, {.max_work = 4}).complete);
}

TEST_F(TriangleSets, OfABoxComeWithoutWaitingOnceThePagesAreThere) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  const Box box{{0.7, -0.2, -0.1}, {1.3, 0.2, 0.1}};
  found_.resize(2000);
  EXPECT_FALSE(probe.triangles_within(box, found_, {.wait = Wait::kNever}).complete);
  EXPECT_TRUE(eventually(
      [&] { return probe.triangles_within(box, found_, {.wait = Wait::kNever}).complete; }));
}

// Each query has its share of the answers.
TEST_F(TriangleSets, OfABatchHaveTheBitsOfSingleQueries) {
  const Model one = sample_.open(), other = sample_.open_for_batches(2);
  Probe single = make_probe(one), batch = make_probe(other);
  constexpr std::size_t kShare = 5;
  constexpr double kRadius = 0.6;
  const std::vector<Vec3> queries = random_queries(300, -1.5, 1.5);
  std::vector<ClosestPoint> answers(kShare * queries.size()), expected(kShare);
  std::vector<Found> sets(queries.size());
  const auto compare = [&](const auto& find) {
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const Found set = find(queries[i]);
      ASSERT_EQ(sets[i].count, set.count);
      ASSERT_EQ(sets[i].complete, set.complete);
      for (std::size_t k = 0; k < set.count; ++k)
        ASSERT_EQ(bits_of(answers[i * kShare + k]), bits_of(expected[k]));
    }
  };
  batch.nearest_triangles(queries, answers, sets);
  compare([&](const Vec3& query) { return single.nearest_triangles(query, expected); });
  batch.triangles_within(queries, kRadius, answers, sets);
  compare([&](const Vec3& query) { return single.triangles_within(query, kRadius, expected); });
  batch.contacts(queries, kRadius, answers, sets);
  compare([&](const Vec3& query) { return single.contacts(query, kRadius, expected); });
  batch.contacts(std::span<const Vec3>(), kRadius, {}, {});
}

TEST_F(TriangleSets, DoNotAllocate) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  probe.nearest_triangles({0, 0, 2}, found_);
  const std::uint64_t allocations = cache::allocation_count();
  for (const double radius : {0.0, 0.3, kInfinity}) {
    probe.triangles_within({0.4, 0, 1}, radius, found_);
    probe.triangles_within({0.4, 0, 1}, radius, found_, {.wait = Wait::kNever});
  }
  EXPECT_EQ(cache::allocation_count(), allocations);
}

TEST_F(TriangleSets, KeepToTheLimitsOfTheQuery) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  const Vec3 above{0, 0, 1.25};
  const double distance = probe.closest_point(above).distance;
  const Found none =
      probe.nearest_triangles(above, found_, {.max_distance = std::nextafter(distance, 0)});
  EXPECT_EQ(none.count, 0u);
  EXPECT_TRUE(none.complete);
  const Found some = probe.nearest_triangles(above, found_, {.max_distance = distance});
  EXPECT_GT(some.count, 0u);
  EXPECT_TRUE(some.complete);
  const Found spent = probe.nearest_triangles(above, found_, {.max_work = 0});
  EXPECT_EQ(spent.count, 0u);
  EXPECT_FALSE(spent.complete);
}

TEST_F(TriangleSets, RefuseQueriesOutOfRange) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Found& set :
       {probe.nearest_triangles({nan, 0, 0}, found_),
        probe.nearest_triangles({0, 1e305, 0}, found_),
        probe.triangles_within({0, 0, 0}, -1, found_),
        probe.triangles_within({0, 0, 0}, nan, found_), probe.triangles_within({0, 0, 0}, 1, {})}) {
    EXPECT_EQ(set.count, 0u);
    EXPECT_FALSE(set.complete);
  }
  EXPECT_TRUE(probe.nearest_triangles({0, 0, 0}, {}).complete);
}

// Beyond a wall of the region lie triangles that the file lacks.
TEST_F(TriangleSets, OfARegionAreCompleteWithinItsWalls) {
  storage::TemporaryDirectory folder;
  BuildOptions options;
  options.box = Box{{0.5, -0.5, -0.5}, {1.5, 0.5, 0.5}};
  build_soup(octree::sphere(5), folder / "part.ptree", options);
  const auto model = Model::open(folder / "part.ptree");
  ASSERT_TRUE(model);
  Probe probe = make_probe(*model);
  found_.resize(4000);
  EXPECT_TRUE(probe.triangles_within({1, 0, 0}, 0.2, found_).complete);
  EXPECT_FALSE(probe.triangles_within({1, 0, 0}, 0.9, found_).complete);
}

}  // namespace
}  // namespace planetree::query
