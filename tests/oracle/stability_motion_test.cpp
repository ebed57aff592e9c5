// The same model larger, elsewhere, turned: the same answers.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/oracle/answer_checks.h"
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

Vec3 scaled(const Vec3& p, int exponent) {
  return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
}

// Every power of two from 2^-40 to 2^40 scales every number of an answer
// without changing a bit of its fraction.
TEST(StabilityMotion, ScalingByAPowerOfTwo) {
  const Soup triangles = some_triangles(1, 150);
  const std::vector<Vec3> queries = some_queries(triangles, 100);
  BuiltModel original(triangles);
  for (int exponent = -40; exponent <= 40; exponent += 5) {
    BuiltModel model(oracle::scaled(triangles, std::ldexp(1.0, exponent)));
    for (const Vec3& query : queries) {
      ClosestPoint expected = original.ask(query);
      expected.distance = std::ldexp(expected.distance, exponent);
      expected.lower = std::ldexp(expected.lower, exponent);
      expected.upper = std::ldexp(expected.upper, exponent);
      expected.point = scaled(expected.point, exponent);
      expect_same_bits(model.ask(scaled(query, exponent)), expected);
    }
  }
}

// Moved by a power of two that loses no bit of any coordinate, distances keep
// all of theirs.
TEST(StabilityMotion, TranslationByAPowerOfTwo) {
  Random random(2);
  const auto coordinate = [&] { return static_cast<double>(random.below(1 << 20)) * 0x1p-20; };
  const auto place = [&] { return Vec3{coordinate(), coordinate(), coordinate()}; };
  Soup triangles;
  for (int i = 0; i < 150; ++i) triangles.push_back({place(), place(), place()});
  BuiltModel original(triangles);
  std::vector<Vec3> queries;
  for (int i = 0; i < 100; ++i) queries.push_back(place());
  for (const int exponent : {1, 8, 16, 24, 31}) {
    const Vec3 offset = Vec3{1, -1, 1} * std::ldexp(1.0, exponent);
    BuiltModel model(moved(triangles, offset));
    for (const Vec3& query : queries) {
      const ClosestPoint expected = original.ask(query);
      const ClosestPoint answer = expect_sound(model, query + offset);
      EXPECT_EQ(answer.distance, expected.distance);
      EXPECT_EQ(answer.triangle, expected.triangle);
      EXPECT_EQ(answer.feature, expected.feature);
    }
  }
}

// Turned about an axis, distances change by no more than turning rounds the
// coordinates.
TEST(StabilityMotion, Rotation) {
  const Soup triangles = some_triangles(3, 150);
  BuiltModel original(triangles);
  const std::vector<Vec3> queries = some_queries(triangles, 100);
  for (const double angle : {0.1, 1.0, 2.5}) {
    const double c = std::cos(angle), s = std::sin(angle);
    const auto turned = [&](const Vec3& p) {
      return Vec3{c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    };
    Soup around = triangles;
    for (Corners& triangle : around)
      for (Vec3& corner : triangle) corner = turned(corner);
    BuiltModel model(around);
    for (const Vec3& query : queries) {
      const double before = original.ask(query).distance;
      const double largest = 3 + std::fabs(query.x) + std::fabs(query.y) + std::fabs(query.z);
      EXPECT_NEAR(expect_sound(model, turned(query)).distance, before, 8 * 0x1p-53 * largest);
    }
  }
}

// Twice as many pages, or one: the page size changes no answer.
TEST(StabilityMotion, PageSizeDoesNotMatter) {
  const Soup triangles = some_triangles(4, 3000);
  BuiltModel original(triangles);
  const std::vector<Vec3> queries = some_queries(triangles, 200);
  for (const std::uint32_t page_bytes : {4096U, 16384U, 262144U}) {
    BuiltModel model(triangles, {page_bytes, 8 << 20, 1});
    for (const Vec3& query : queries) expect_same_bits(model.ask(query), original.ask(query));
  }
}

}  // namespace
}  // namespace planetree::oracle
