// Sets of triangles about nasty points of nasty models, against all triangles.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "octree/geometry/triangle_distance.h"
#include "tests/oracle/brute_force.h"
#include "tests/oracle/nasty_models.h"

namespace planetree::oracle {
namespace {

struct Ranked {
  double distance;
  std::uint64_t triangle;
  bool operator<(const Ranked& other) const {
    return distance != other.distance ? distance < other.distance : triangle < other.triangle;
  }
};

// All triangles by (distance, index), with the arithmetic of the library.
std::vector<Ranked> ranked(const BuiltModel& model, const Vec3& query) {
  const auto in = [&](const Vec3& point) -> octree::Point {
    const int exponent = model.scale_exponent();
    return {std::ldexp(point.x, exponent), std::ldexp(point.y, exponent),
            std::ldexp(point.z, exponent)};
  };
  std::vector<Ranked> all;
  for (std::size_t i = 0; i < model.triangles().size(); ++i) {
    const Corners& corners = model.triangles()[i];
    const double squared =
        octree::triangle_value(in(query), {in(corners[0]), in(corners[1]), in(corners[2])}).squared;
    all.push_back({std::ldexp(std::sqrt(squared), -model.scale_exponent()), i});
  }
  std::sort(all.begin(), all.end());
  return all;
}

void expect_interval(const BuiltModel& model, const Vec3& query, const ClosestPoint& answer) {
  const Wide truth =
      exact_distance(query, std::span(model.triangles()).subspan(answer.triangle, 1));
  EXPECT_LE(Wide(answer.lower), truth);
  EXPECT_GE(Wide(answer.upper), truth);
}

// Asks for the nearest triangles, and for all within the distance of one of them.
void expect_sets(BuiltModel& model, const Vec3& query, Random& random) {
  const std::vector<Ranked> all = ranked(model, query);
  std::vector<ClosestPoint> found(1 + random.below(40));
  const QueryOptions options{.parts = kDistance};
  const Found nearest = model.probe().nearest_triangles(query, found, options);
  ASSERT_TRUE(nearest.complete);
  ASSERT_EQ(nearest.count, std::min(found.size(), all.size()));
  for (std::size_t i = 0; i < nearest.count; ++i) {
    ASSERT_EQ(found[i].triangle, all[i].triangle) << i;
    ASSERT_EQ(found[i].distance, all[i].distance) << i;
    ASSERT_EQ(found[i].status, Status::kExact) << i;
    expect_interval(model, query, found[i]);
  }
  const double radius = all[random.below(std::min<std::size_t>(all.size(), 60))].distance;
  const auto within = static_cast<std::size_t>(
      std::upper_bound(all.begin(), all.end(), Ranked{radius, kNoTriangle}) - all.begin());
  const Found set = model.probe().triangles_within(query, radius, found, options);
  EXPECT_EQ(set.complete, within <= found.size());
  ASSERT_EQ(set.count, std::min(within, found.size()));
  for (std::size_t i = 0; i < set.count; ++i) ASSERT_EQ(found[i].triangle, all[i].triangle) << i;
}

TEST(TriangleSets, AreThoseOfAllTriangles) {
  for (const NastyFamily& family : nasty_families()) {
    SCOPED_TRACE(std::string(family.name));
    Random random(31);
    for (int i = 0; i < 3; ++i) {
      BuiltModel model(family.make(random), {4096});
      for (int k = 0; k < 25 && !testing::Test::HasFatalFailure(); ++k) {
        const Vec3 query = nasty_query(random, model.triangles(), 1);
        SCOPED_TRACE(testing::Message() << query.x << ' ' << query.y << ' ' << query.z);
        if (std::fabs(query.x) + std::fabs(query.y) + std::fabs(query.z) < 1e60)
          expect_sets(model, query, random);
      }
    }
  }
}

// With limited work, what is marked exact is in its place.
TEST(TriangleSets, OfLittleWorkTellWhatIsProven) {
  int exact = 0, degraded = 0;
  for (const NastyFamily& family : nasty_families()) {
    SCOPED_TRACE(std::string(family.name));
    Random random(32);
    BuiltModel model(family.make(random), {4096});
    for (int k = 0; k < 40; ++k) {
      const Vec3 query =
          point_on(random, model.triangles()[random.below(model.triangles().size())]);
      const std::vector<Ranked> all = ranked(model, query);
      std::vector<ClosestPoint> found(12);
      const auto work = static_cast<std::uint32_t>(random.below(60));
      const Found set =
          model.probe().nearest_triangles(query, found, {.parts = kDistance, .max_work = work});
      if (set.complete) {
        ASSERT_EQ(set.count, std::min(found.size(), all.size()));
      }
      for (std::size_t i = 0; i < set.count; ++i) {
        expect_interval(model, query, found[i]);
        const bool is_exact = found[i].status == Status::kExact;
        (is_exact ? exact : degraded) += 1;
        if (is_exact) {
          ASSERT_EQ(found[i].triangle, all[i].triangle) << i;
        }
        ASSERT_TRUE(is_exact || !set.complete);
      }
    }
  }
  EXPECT_GT(exact, 100);
  EXPECT_GT(degraded, 100);
}

}  // namespace
}  // namespace planetree::oracle
