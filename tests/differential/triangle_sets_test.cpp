// Sets of triangles about nasty points of nasty models, against all triangles.
// PLANETREE_TEST_EFFORT in the environment multiplies the number of models
// or of queries.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <vector>

#include "octree/geometry/triangle_distance.h"
#include "tests/oracle/brute_force.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/random.h"

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
    for (int i = 0; i < 3 * test_effort(); ++i) {
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

using Fraction = boost::multiprecision::cpp_rational;
using Exact = std::array<Fraction, 3>;

// What is left of a convex polygon on one side of a plane across an axis.
std::vector<Exact> clipped(const std::vector<Exact>& polygon, std::size_t axis, const Fraction& at,
                           bool keeps_above) {
  std::vector<Exact> kept;
  const auto height = [&](const Exact& corner) {
    return keeps_above ? Fraction(corner[axis] - at) : Fraction(at - corner[axis]);
  };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Exact &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const Fraction above = height(a), other = height(b);
    if (above >= 0) kept.push_back(a);
    if ((above < 0 && other > 0) || (above > 0 && other < 0)) {
      const Fraction share = above / (above - other);
      Exact cut;
      for (std::size_t k = 0; k < 3; ++k) cut[k] = a[k] + share * (b[k] - a[k]);
      kept.push_back(cut);
    }
  }
  return kept;
}

// The sides of a box that a point is beyond, a bit each.
unsigned sides_beyond(const Vec3& point, const Box& box) {
  const bool beyond[] = {
      point
          .x<box.lower.x,
             point.y<box.lower.y, point.z<box.lower.z, point.x> box.upper.x, point.y> box.upper.y,
             point.z>
              box.upper.z};
  unsigned sides = 0;
  for (std::size_t side = 0; side < std::size(beyond); ++side)
    sides |= unsigned{beyond[side]} << side;
  return sides;
}

// Whether a closed triangle touches a closed box: by its corners where these tell it, else by
// clipping with fractions.
bool touches(const Corners& triangle, const Box& box) {
  const unsigned a = sides_beyond(triangle[0], box), b = sides_beyond(triangle[1], box),
                 c = sides_beyond(triangle[2], box);
  if ((a & b & c) != 0) return false;
  if (a == 0 || b == 0 || c == 0) return true;
  const std::array<double, 3> lower{box.lower.x, box.lower.y, box.lower.z};
  const std::array<double, 3> upper{box.upper.x, box.upper.y, box.upper.z};
  std::vector<Exact> polygon;
  for (const Vec3& corner : triangle) polygon.push_back({corner.x, corner.y, corner.z});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    polygon = clipped(polygon, axis, lower[axis], true);
    polygon = clipped(polygon, axis, upper[axis], false);
  }
  return !polygon.empty();
}

// A box about a point, whose faces lie in corners of the model now and then.
Box nasty_box(Random& random, std::span<const Corners> triangles) {
  const Vec3 one = nasty_query(random, triangles, 1);
  Vec3 other = nasty_query(random, triangles, 1);
  if (random.one_in(3)) other = one + random.in_some_cube(-30, 0);
  if (random.one_in(4)) other.z = one.z;
  return {{std::min(one.x, other.x), std::min(one.y, other.y), std::min(one.z, other.z)},
          {std::max(one.x, other.x), std::max(one.y, other.y), std::max(one.z, other.z)}};
}

TEST(TriangleSets, OfBoxesAreThoseThatTouch) {
  std::size_t some = 0, others = 0;
  for (const NastyFamily& family : nasty_families()) {
    SCOPED_TRACE(std::string(family.name));
    Random random(33);
    BuiltModel model(family.make(random), {4096});
    for (int k = 0; k < 25 * test_effort() && !testing::Test::HasFailure(); ++k) {
      const Box box = nasty_box(random, model.triangles());
      if (std::fabs(box.lower.x) + std::fabs(box.upper.y) + std::fabs(box.lower.z) > 1e9) continue;
      std::vector<std::uint64_t> expected;
      for (std::size_t i = 0; i < model.triangles().size(); ++i)
        if (touches(model.triangles()[i], box)) expected.push_back(i);
      std::vector<ClosestPoint> found(model.triangles().size() + 1);
      const Found set = model.probe().triangles_within(box, found, {.parts = kDistance});
      EXPECT_TRUE(set.complete);
      found.resize(set.count);
      EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), [](const auto& a, const auto& b) {
        return a.distance < b.distance;
      }));
      std::vector<std::uint64_t> indices;
      for (const ClosestPoint& answer : found) indices.push_back(answer.triangle);
      std::sort(indices.begin(), indices.end());
      EXPECT_EQ(indices, expected);
      some += expected.size();
      others += model.triangles().size() - expected.size();
    }
  }
  EXPECT_GT(some, 1000u);
  EXPECT_GT(others, 1000u);
}

// With limited work, what is marked exact is in its place.
TEST(TriangleSets, OfLittleWorkTellWhatIsProven) {
  int exact = 0, degraded = 0;
  for (const NastyFamily& family : nasty_families()) {
    SCOPED_TRACE(std::string(family.name));
    Random random(32);
    BuiltModel model(family.make(random), {4096});
    for (int k = 0; k < 40 * test_effort(); ++k) {
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
