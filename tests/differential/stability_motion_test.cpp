// The same model scaled, translated or rotated gives the same answers.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/differential/answer_checks.h"
#include "tests/oracle/closed_models.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/random.h"

namespace planetree::oracle {
namespace {

Soup some_triangles(std::uint64_t seed, int count) {
  Random random(seed);
  Soup triangles;
  for (int i = 0; i < count; ++i) {
    const Vec3 at = random.in_cube();
    triangles.push_back({at, at + random.in_cube() * 0.2, at + random.in_cube() * 0.2});
  }
  return triangles;
}

std::vector<Vec3> some_queries(const Soup& triangles, int count) {
  Random random(31);
  std::vector<Vec3> queries;
  for (int i = 0; i < count; ++i) queries.push_back(nasty_query(random, triangles, 1));
  return queries;
}

Vec3 by_power_of_two(const Vec3& p, int exponent) {
  return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
}

// Every power of two from 2^-40 to 2^40 scales every number of an answer without changing a bit of
// its fraction.
TEST(StabilityMotion, ScalingByAPowerOfTwo) {
  const Soup triangles = some_triangles(1, 150);
  const std::vector<Vec3> queries = some_queries(triangles, 100);
  BuiltModel original(triangles);
  for (int exponent = -40; exponent <= 40; exponent += 5) {
    BuiltModel model(scaled(triangles, std::ldexp(1.0, exponent)));
    for (const Vec3& query : queries) {
      ClosestPoint expected = original.closest_point(query);
      expected.distance = std::ldexp(expected.distance, exponent);
      expected.lower = std::ldexp(expected.lower, exponent);
      expected.upper = std::ldexp(expected.upper, exponent);
      expected.point = by_power_of_two(expected.point, exponent);
      expect_same_bits(model.closest_point(by_power_of_two(query, exponent)), expected);
    }
  }
}

// Translated by a power of two that loses no bit of any coordinate, a model keeps every bit of its
// distances.
TEST(StabilityMotion, TranslationByAPowerOfTwo) {
  Random random(2);
  const auto coordinate = [&] { return static_cast<double>(random.below(1 << 20)) * 0x1p-20; };
  const auto lattice_point = [&] { return Vec3{coordinate(), coordinate(), coordinate()}; };
  Soup triangles;
  for (int i = 0; i < 150; ++i)
    triangles.push_back({lattice_point(), lattice_point(), lattice_point()});
  BuiltModel original(triangles);
  std::vector<Vec3> queries;
  for (int i = 0; i < 100; ++i) queries.push_back(lattice_point());
  for (const int exponent : {1, 8, 16, 24, 31}) {
    const Vec3 offset = Vec3{1, -1, 1} * std::ldexp(1.0, exponent);
    BuiltModel model(translated(triangles, offset));
    for (const Vec3& query : queries) {
      const ClosestPoint expected = original.closest_point(query);
      const ClosestPoint answer = expect_sound(model, query + offset);
      EXPECT_EQ(answer.distance, expected.distance);
      EXPECT_EQ(answer.triangle, expected.triangle);
      EXPECT_EQ(answer.feature, expected.feature);
    }
  }
}

// A rotation about an axis changes distances by no more than it rounds the coordinates.
TEST(StabilityMotion, Rotation) {
  const Soup triangles = some_triangles(3, 150);
  BuiltModel original(triangles);
  const std::vector<Vec3> queries = some_queries(triangles, 100);
  for (const double angle : {0.1, 1.0, 2.5}) {
    const double c = std::cos(angle), s = std::sin(angle);
    const auto rotated = [&](const Vec3& p) {
      return Vec3{c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    };
    Soup around = triangles;
    for (Corners& triangle : around)
      for (Vec3& corner : triangle) corner = rotated(corner);
    BuiltModel model(around);
    for (const Vec3& query : queries) {
      const double before = original.closest_point(query).distance;
      const double largest = 3 + std::fabs(query.x) + std::fabs(query.y) + std::fabs(query.z);
      EXPECT_NEAR(expect_sound(model, rotated(query)).distance, before, 8 * 0x1p-53 * largest);
    }
  }
}

// Watertight models whose coordinates have few enough bits.
Soup closed_model(std::uint64_t seed) {
  Random random(seed);
  const auto coordinate = [&] { return static_cast<double>(random.below(1 << 20)) * 0x1p-20; };
  const auto lattice_point = [&] {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    return Vec3{x, y, z};
  };
  Soup soup;
  for (int i = 0; i < 20; ++i) {
    const Vec3 a = lattice_point(), b = lattice_point(), c = lattice_point(), d = lattice_point();
    soup = soup + tetrahedron(a, b, c, d);
  }
  return soup;
}

void expect_same_distance_and_side(const ClosestPoint& answer, const ClosestPoint& expected) {
  EXPECT_EQ(answer.distance, expected.distance);
  EXPECT_EQ(answer.side, expected.side);
  EXPECT_EQ(answer.status, expected.status);
}

void expect_direction(const Vec3& found, const Vec3& expected) {
  EXPECT_NEAR(found.x, expected.x, 1e-7);
  EXPECT_NEAR(found.y, expected.y, 1e-7);
  EXPECT_NEAR(found.z, expected.z, 1e-7);
}

// Whether the direction to the query can orient the normal.
bool has_certain_direction(const ClosestPoint& answer) { return answer.distance > 1e-9; }

TEST(StabilityMotion, ScalingAWatertightModelByAPowerOfTwo) {
  const Soup triangles = closed_model(5);
  const std::vector<Vec3> queries = some_queries(triangles, 100);
  BuiltModel original(triangles);
  ASSERT_TRUE(original.model().info().watertight());
  for (int exponent = -40; exponent <= 40; exponent += 10) {
    BuiltModel model(scaled(triangles, std::ldexp(1.0, exponent)));
    for (const Vec3& query : queries) {
      const ClosestPoint expected = original.closest_point(query);
      const ClosestPoint answer = model.closest_point(by_power_of_two(query, exponent));
      EXPECT_EQ(answer.distance, std::ldexp(expected.distance, exponent));
      EXPECT_EQ(answer.side, expected.side);
      EXPECT_EQ(answer.normal.x, expected.normal.x);
      EXPECT_EQ(answer.normal.y, expected.normal.y);
      EXPECT_EQ(answer.normal.z, expected.normal.z);
    }
  }
}

TEST(StabilityMotion, TranslationOfAWatertightModel) {
  const Soup triangles = closed_model(6);
  Random random(6);
  BuiltModel original(triangles);
  for (const Vec3& offset : {Vec3{1, -3, 0.5}, Vec3{-4096, 0, 1024.25}, Vec3{1, 1, 1} * 0x1p30}) {
    BuiltModel model(translated(triangles, offset));
    for (int i = 0; i < 100; ++i) {
      const Vec3 on_lattice = [&] {
        const auto coordinate = [&] {
          return static_cast<double>(random.below(1 << 21)) * 0x1p-20 - 0.5;
        };
        const double x = coordinate(), y = coordinate(), z = coordinate();
        return Vec3{x, y, z};
      }();
      const Vec3 query = i % 3 == 0 ? triangles[random.below(triangles.size())][0] : on_lattice;
      const ClosestPoint expected = original.closest_point(query),
                         answer = model.closest_point(query + offset);
      expect_same_distance_and_side(answer, expected);
      EXPECT_EQ(answer.triangle, expected.triangle);
      expect_direction(answer.normal, expected.normal);
    }
  }
}

// Reordering triangles changes their indices and nothing else.
TEST(StabilityMotion, OrderOfTriangles) {
  Soup triangles = closed_model(7);
  const std::vector<Vec3> queries = some_queries(triangles, 200);
  BuiltModel original(triangles);
  std::vector<std::uint64_t> was(triangles.size());
  for (std::size_t i = 0; i < was.size(); ++i) was[i] = i;
  Random random(7);
  for (std::size_t i = was.size() - 1; i > 0; --i) {
    const std::size_t other = random.below(i + 1);
    std::swap(was[i], was[other]);
    std::swap(triangles[i], triangles[other]);
  }
  BuiltModel model(triangles);
  for (const Vec3& query : queries) {
    const ClosestPoint expected = original.closest_point(query),
                       answer = expect_sound(model, query);
    expect_same_distance_and_side(answer, expected);
    if (was[answer.triangle] != expected.triangle) continue;  // a tie, and now the first
    EXPECT_EQ(answer.lower, expected.lower);
    EXPECT_EQ(answer.upper, expected.upper);
    EXPECT_EQ(answer.feature, expected.feature);
    expect_direction(answer.normal, expected.normal);
  }
}

// Corners in reverse order, or starting with another corner.
TEST(StabilityMotion, OrderOfCorners) {
  Soup triangles = closed_model(8);
  const std::vector<Vec3> queries = some_queries(triangles, 200);
  BuiltModel original(triangles);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t turns = i % 3; turns > 0; --turns)
      triangles[i] = {triangles[i][1], triangles[i][2], triangles[i][0]};
  BuiltModel rotated(triangles), reversed(inside_out(triangles));
  for (const Vec3& query : queries) {
    const ClosestPoint expected = original.closest_point(query);
    for (BuiltModel* model : {&rotated, &reversed}) {
      const ClosestPoint answer = expect_sound(*model, query);
      expect_same_distance_and_side(answer, expected);
      EXPECT_EQ(answer.triangle, expected.triangle);
      EXPECT_EQ(answer.feature, expected.feature);
    }
    // Normals point out of the solid, however its faces are oriented.
    if (has_certain_direction(expected)) {
      expect_direction(rotated.closest_point(query).normal, expected.normal);
      expect_direction(reversed.closest_point(query).normal, expected.normal);
    }
  }
}

// A mirror reverses faces. What is inside stays inside, and so the direction out of the solid stays
// too.
TEST(StabilityMotion, Mirror) {
  const auto mirrored = [](const Vec3& p) { return Vec3{p.x, -p.y, p.z}; };
  Soup open = some_triangles(9, 100);
  for (Soup triangles : {closed_model(9), ball(2), open}) {
    BuiltModel original(triangles);
    const std::vector<Vec3> queries = some_queries(triangles, 150);
    for (Corners& triangle : triangles)
      for (Vec3& corner : triangle) corner = mirrored(corner);
    BuiltModel model(triangles);
    EXPECT_EQ(model.model().info().watertight(), original.model().info().watertight());
    for (const Vec3& query : queries) {
      const ClosestPoint expected = original.closest_point(query);
      const ClosestPoint answer = expect_sound(model, mirrored(query));
      EXPECT_EQ(answer.side, expected.side);
      EXPECT_LE(answer.lower, expected.upper);
      EXPECT_GE(answer.upper, expected.lower);
      if (answer.triangle != expected.triangle || answer.feature != expected.feature) continue;
      if (has_certain_direction(expected))
        expect_direction(answer.normal, mirrored(expected.normal));
    }
  }
}

// Flat faces split into four give the same surface.
TEST(StabilityMotion, SubdivisionOfFlatFaces) {
  const Soup coarse = box({0, 0, 0}, {1, 1, 1}) + box({0.25, 0.5, 0.75}, {2, 1.5, 1.25}) +
                      tetrahedron({-2, 0, 0}, {-2, 1, 0}, {-1, 0, 0}, {-2, 0, 1});
  Soup fine;
  for (const Corners& t : coarse) {
    const Vec3 a = (t[0] + t[1]) * 0.5, b = (t[1] + t[2]) * 0.5, c = (t[2] + t[0]) * 0.5;
    fine = fine + Soup{{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}};
  }
  BuiltModel left(coarse), right(fine);
  Random random(10);
  for (int i = 0; i < 300; ++i) {
    const Vec3 query = i % 2 == 0 ? random.in_cube() * 3 : nasty_query(random, coarse, 1);
    const ClosestPoint expected = expect_sound(left, query), answer = expect_sound(right, query);
    EXPECT_EQ(answer.side, expected.side);
    EXPECT_LE(answer.lower, expected.upper);
    EXPECT_GE(answer.upper, expected.lower);
    const Vec3 apart = answer.point - expected.point;
    // Otherwise two points are equally far.
    if (std::fabs(apart.x) + std::fabs(apart.y) + std::fabs(apart.z) > 1e-12) continue;
    if (answer.side != Side::kOnSurface) expect_direction(answer.normal, expected.normal);
  }
}

// The page size changes no answer, whether there are many pages or one.
TEST(StabilityMotion, PageSizeDoesNotMatter) {
  const Soup triangles = some_triangles(4, 3000);
  BuiltModel original(triangles);
  const std::vector<Vec3> queries = some_queries(triangles, 200);
  for (const std::uint32_t page_bytes : {4096U, 16384U, 262144U}) {
    BuiltModel model(triangles, {page_bytes, 8 << 20, 1});
    for (const Vec3& query : queries)
      expect_same_bits(model.closest_point(query), original.closest_point(query));
  }
}

}  // namespace
}  // namespace planetree::oracle
