#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <vector>

#include "planetree/probe.h"
#include "tests/query/answer_bits.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

using octree::repeated;
using octree::scattered;
using octree::sphere;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double length(const Vec3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

TEST(ClosestPoint, IsNearestAndOnItsTriangle) {
  // In these input units the model is 2^7 times as large as in the model frame.
  Soup soup = sphere(4);
  for (auto& triangle : soup)
    for (Vec3& corner : triangle) corner = {corner.x * 100, corner.y * 100, corner.z * 100};
  const SampleModel sample(soup);
  const Model model = sample.open();
  Probe probe = make_probe(model);
  for (const Vec3& query : random_queries(300, -180, 180)) {
    const ClosestPoint answer = probe.closest_point(query);
    ASSERT_EQ(answer.status, Status::kExact);
    EXPECT_EQ(answer.distance, sample.distance(query));
    EXPECT_EQ(answer.triangle, sample.nearest_triangle(query));
    EXPECT_TRUE(sample.interval_holds(answer, query));
    EXPECT_LT(answer.upper - answer.lower, 1e-10);
    const auto& [a, b, c] = soup[answer.triangle];
    const auto& [u, v, w] = answer.barycentric;
    EXPECT_NEAR(u + v + w, 1, 1e-15);
    const Vec3 off{u * a.x + v * b.x + w * c.x - answer.point.x,
                   u * a.y + v * b.y + w * c.y - answer.point.y,
                   u * a.z + v * b.z + w * c.z - answer.point.z};
    EXPECT_LT(length(off), 1e-12);
  }
}

TEST(ClosestPoint, RefusesBadQueriesAndOptions) {
  const SampleModel sample(repeated(1));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  struct Row {
    Vec3 query;
    QueryOptions options;
  };
  std::vector<Row> rows;
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    rows.push_back({{bad, 0, 0}, {}});
    rows.push_back({{0, bad, 0}, {}});
    rows.push_back({{0, 0, bad}, {}});
    rows.push_back({{}, {.max_error = bad}});
  }
  rows.push_back({{}, {.max_error = -1e-300}});
  rows.push_back({{}, {.max_distance = kNaN}});
  rows.push_back({{}, {.max_distance = -1}});
  rows.push_back({{}, {.max_distance = -kInfinity}});
  for (const Row& row : rows) {
    const ClosestPoint answer = probe.closest_point(row.query, row.options);
    EXPECT_EQ(answer.status, Status::kBadQuery);
    EXPECT_EQ(answer.lower, 0);
    EXPECT_EQ(answer.upper, kInfinity);
    EXPECT_EQ(answer.distance, kInfinity);
    EXPECT_EQ(answer.triangle, kNoTriangle);
    EXPECT_FALSE(std::isnan(answer.point.x + answer.barycentric.x));
  }
  EXPECT_EQ(probe.closest_point({}, {.max_error = 0, .max_distance = kInfinity}).status,
            Status::kExact);
}

TEST(ClosestPoint, AnswersQueriesFromVeryFarAway) {
  const SampleModel sample(sphere(3));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  for (const double far : {1e6, 1e15, 1e30, 1e80, 1e91, 1e200, 1e300, 1.7e308})
    for (const Vec3& query : {Vec3{far, 0, 0}, Vec3{-far, far, -far / 3}}) {
      const ClosestPoint answer = probe.closest_point(query);
      EXPECT_EQ(answer.status, Status::kExact) << far;
      EXPECT_NE(answer.triangle, kNoTriangle);
      EXPECT_LT(answer.lower, answer.upper);
      // Divided first, so that the true distance is a double.
      const double truth = length({query.x / far, query.y / far, query.z / far});
      EXPECT_LE(answer.lower / far, truth);
      EXPECT_GE(answer.upper / far, truth - 1 / far);
      EXPECT_NEAR(answer.barycentric.x + answer.barycentric.y + answer.barycentric.z, 1, 1e-15);
      EXPECT_LE(length(answer.point), 1.0000001);
    }
}

TEST(ClosestPoint, ReturnsTheLowestIndexAmongEqualDistances) {
  const SampleModel sample(repeated(100), 4096, 7);
  const Model model = sample.open();
  Probe probe = make_probe(model);
  EXPECT_EQ(probe.closest_point({0.2, 0.2, 3}).triangle, 7u);
  EXPECT_EQ(probe.closest_point({1e300, 0, 0}).triangle, 7u);
  EXPECT_EQ(probe.closest_point({0, 0, 0}).triangle, 7u);
}

TEST(ClosestPoint, CountsTrianglesBeyond32Bits) {
  const std::uint64_t first = (std::uint64_t{1} << 40) + 5;
  const SampleModel sample(sphere(3), 4096, first);
  const Model model = sample.open();
  Probe probe = make_probe(model);
  for (const Vec3& query : random_queries(50, -1.5, 1.5)) {
    const ClosestPoint answer = probe.closest_point(query);
    EXPECT_GE(answer.triangle, first);
    EXPECT_EQ(answer.triangle, sample.nearest_triangle(query));
  }
}

TEST(ClosestPoint, StopsAtMaxDistance) {
  const SampleModel sample(sphere(4));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  for (const Vec3& query : random_queries(200, -2, 2)) {
    const double truth = sample.distance(query);
    for (const double share : {0.0, 0.5, 0.999999, 1.000001, 3.0}) {
      const QueryOptions options{.max_distance = truth * share};
      const ClosestPoint answer = probe.closest_point(query, options);
      if (share < 1) {
        EXPECT_EQ(answer.status, Status::kBeyondMaxDistance);
        EXPECT_EQ(answer.lower, options.max_distance);
        EXPECT_EQ(answer.upper, kInfinity);
        EXPECT_EQ(answer.distance, kInfinity);
        EXPECT_EQ(answer.triangle, kNoTriangle);
      } else {
        EXPECT_EQ(answer.status, Status::kExact);
        EXPECT_EQ(answer.distance, truth);
      }
    }
  }
  const ClosestPoint far = probe.closest_point({1e300, 0, 0}, {.max_distance = 1e299});
  EXPECT_EQ(far.status, Status::kBeyondMaxDistance);
  EXPECT_EQ(far.lower, 1e299);
  EXPECT_EQ(probe.closest_point({1, 0, 0}, {.max_distance = 0}).status, Status::kExact);
}

TEST(ClosestPoint, StaysWithinMaxError) {
  const SampleModel sample(sphere(4));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  int within = 0;
  // Another query near the last one might be answered exactly.
  for (const double error : {1e-9, 1e-3, 0.05, 1.0, 1e300}) {
    for (const Vec3& query : random_queries(150, -1.5, 1.5)) {
      const ClosestPoint answer = probe.closest_point(query, {.max_error = error});
      EXPECT_TRUE(answer.status == Status::kExact || answer.status == Status::kWithinError);
      EXPECT_LE(answer.upper - answer.lower, error);
      EXPECT_TRUE(sample.interval_holds(answer, query));
      within += answer.status == Status::kWithinError;
    }
  }
  EXPECT_GT(within, 50);
}

// Subnormal lengths are multiples of 2^-1074, so that an interval gets wider when it is scaled
// back.
TEST(ClosestPoint, StaysWithinMaxErrorAtSubnormalLengths) {
  constexpr double kUnit = 0x1p-1074;
  for (const double size : {8.0, 100.0, 3000.0}) {
    octree::Soup soup = octree::sphere(3);
    for (auto& triangle : soup)
      for (Vec3& corner : triangle)
        corner = {corner.x * size * kUnit, corner.y * size * kUnit, corner.z * size * kUnit};
    const SampleModel sample(soup);
    const Model model = sample.open();
    Probe probe = make_probe(model);
    for (const double allowed : {1.0, 2.0, 3.0, 8.0, 60.0})
      for (const Vec3& query : random_queries(40, -2, 2)) {
        const Vec3 scaled{query.x * size * kUnit, query.y * size * kUnit, query.z * size * kUnit};
        const ClosestPoint answer = probe.closest_point(scaled, {.max_error = allowed * kUnit});
        if (answer.status == Status::kWithinError) {
          EXPECT_LE(answer.upper - answer.lower, allowed * kUnit);
        }
      }
  }
}

TEST(ClosestPoint, IntervalHoldsTheTruthUnderAnyLimits) {
  const SampleModel sample(scattered(1200, 0.2));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  octree::Noise noise(9);
  int counts[5] = {};
  for (const Vec3& query : random_queries(600, -1, 2)) {
    QueryOptions options;
    if (noise.bits() % 2 == 0) options.max_work = noise.bits() % 40;
    if (noise.bits() % 2 == 0) options.max_error = noise.uniform(0, 0.3);
    if (noise.bits() % 3 == 0) options.max_distance = noise.uniform(0, 1);
    const ClosestPoint answer = probe.closest_point(query, options);
    EXPECT_TRUE(sample.interval_holds(answer, query));
    ++counts[static_cast<int>(answer.status)];
  }
  for (const Status status :
       {Status::kExact, Status::kWithinError, Status::kDegraded, Status::kBeyondMaxDistance})
    EXPECT_GT(counts[static_cast<int>(status)], 10);
}

TEST(ClosestPoint, AnswersFromTheHeaderWithZeroWork) {
  const SampleModel sample(sphere(5));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  const std::uint64_t hits = model.stats().page_hits;
  const Vec3 query{0.5, 0.25, 3};
  const ClosestPoint answer = probe.closest_point(query, {.max_work = 0});
  EXPECT_EQ(answer.status, Status::kDegraded);
  EXPECT_EQ(answer.triangle, kNoTriangle);
  EXPECT_EQ(answer.distance, answer.upper);
  EXPECT_TRUE(sample.interval_holds(answer, query));
  EXPECT_GT(answer.lower, 1.9);  // from the model's box
  EXPECT_EQ(model.stats().page_hits, hits);
  EXPECT_EQ(model.stats().degraded_answers, 1u);
}

TEST(ClosestPoint, IntervalHoldsForEveryAmountOfWork) {
  const SampleModel sample(sphere(4));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  for (const Vec3& query : random_queries(15, -1.5, 1.5)) {
    for (std::uint32_t nodes = 0; nodes < 60; ++nodes)
      EXPECT_TRUE(sample.interval_holds(probe.closest_point(query, {.max_work = nodes}), query));
    EXPECT_EQ(probe.closest_point(query, {.max_work = 1}).status, Status::kDegraded);
    EXPECT_EQ(probe.closest_point(query, {.max_work = 5000}).status, Status::kExact);
  }
}

// Before any triangle is found, the boxes on the way to it bound the distance from above.
TEST(ClosestPoint, IntervalNarrowsWithEveryDoublingOfWork) {
  const SampleModel sample(sphere(6));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  std::vector<double> of_eight;
  for (const Vec3& query : random_queries(200, -1.5, 1.5)) {
    double last = std::numeric_limits<double>::infinity();
    for (std::uint32_t work = 1; work <= 4096; work *= 2) {
      const ClosestPoint answer =
          probe.closest_point(query, {.parts = kDistance, .max_work = work});
      EXPECT_TRUE(sample.interval_holds(answer, query));
      const double width = answer.upper - answer.lower;
      EXPECT_LE(width, last * (1 + 1e-6)) << work;
      last = width;
      if (work == 8) of_eight.push_back(width);
    }
  }
  std::ranges::sort(of_eight);
  EXPECT_LT(of_eight[100], 0.2);
  EXPECT_LT(of_eight[197], 0.8);
}

TEST(ClosestPoint, DoesNotDependOnMemoryOrEarlierQueries) {
  const SampleModel sample(scattered(3000, 0.05));
  const Model large = sample.open(), small = sample.open(sample.min_budget());
  ASSERT_GT(large.stats().frames, 4 * small.stats().frames);
  Probe of_large = make_probe(large), of_small = make_probe(small);
  const std::vector<Vec3> queries = random_queries(400, -0.2, 1.2);
  std::vector<AnswerBits> forward;
  for (const Vec3& query : queries) forward.push_back(bits_of(of_large.closest_point(query)));
  for (std::size_t i = queries.size(); i-- > 0;)
    EXPECT_EQ(bits_of(of_small.closest_point(queries[i])), forward[i]);
  EXPECT_GT(small.stats().pages_evicted, 100u);
}

// Limited answers of a batch do not depend on earlier queries.
ClosestPoint batch_of_one(Probe& probe, const Vec3& query, const QueryOptions& options) {
  ClosestPoint answer;
  probe.closest_points(std::span(&query, 1), std::span(&answer, 1), options);
  return answer;
}

// Near the centre of a sphere very many triangles are almost equally near: more candidates are
// found than can be kept.
TEST(ClosestPoint, DoesNotDependOnMemoryUnderErrorAndWorkLimits) {
  const SampleModel sample(octree::sphere(6));
  const Model large = sample.open(), small = sample.open(sample.min_budget());
  Probe of_large = make_probe(large), of_small = make_probe(small);
  std::set<Status> seen;
  for (const double aside : {0.0, 1e-6, 1e-5, 1e-3})
    for (const Vec3& query : random_queries(60, -aside, aside, 13))
      for (const double max_error : {1e-6, 1e-4, 1e-3, 1e-2})
        for (const std::uint32_t max_work : {QueryOptions::kNoLimit, 500u, 3000u}) {
          const QueryOptions options{
              .parts = kDistance, .max_error = max_error, .max_work = max_work};
          const ClosestPoint expected = batch_of_one(of_large, query, options);
          EXPECT_EQ(bits_of(batch_of_one(of_small, query, options)), bits_of(expected));
          seen.insert(expected.status);
        }
  EXPECT_GT(small.stats().pages_evicted, 100u);
  EXPECT_TRUE(seen.contains(Status::kWithinError));
}

}  // namespace
}  // namespace planetree::query
