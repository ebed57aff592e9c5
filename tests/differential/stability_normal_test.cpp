// Pseudo-normals where a plain sum of face normals, or the nearest face alone, has the wrong
// direction.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/differential/answer_checks.h"
#include "tests/oracle/closed_models.h"
#include "tests/oracle/random.h"

namespace planetree::oracle {
namespace {

double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

void expect_direction(const Vec3& found, const Vec3& wanted) {
  const double length = std::sqrt(dot(wanted, wanted));
  EXPECT_NEAR(found.x, wanted.x / length, 1e-12);
  EXPECT_NEAR(found.y, wanted.y / length, 1e-12);
  EXPECT_NEAR(found.z, wanted.z / length, 1e-12);
}

// Queries around corners and edges; expect_sound() checks the normals.
void expect_normals(const Soup& triangles, double size, int count) {
  BuiltModel model(triangles, {4096, 1 << 20, 1});
  Random random(16);
  for (int i = 0; i < count; ++i) {
    const Corners& t = triangles[random.below(triangles.size())];
    const Vec3 at = random.one_in(2) ? t[random.below(3)] : (t[0] + t[1]) * 0.5;
    expect_sound(model, at + random.in_some_cube(-30, 4) * size);
  }
}

// Far from the tip, two of its faces face away from the query.
TEST(StabilityNormal, AcuteTetrahedronFromFar) {
  const Soup spike = tetrahedron({0, 0, 0}, {0, 0.01, 0}, {0.01, 0, 0}, {0.003, 0.003, 1});
  expect_normals(spike, 1, 300);
  BuiltModel model(spike);
  for (const double x : {-100.0, 0.0, 100.0}) {
    const ClosestPoint answer = model.closest_point({x, 50, 100});
    EXPECT_EQ(answer.feature, Feature::kVertex);
    EXPECT_EQ(answer.side, Side::kOutside);
    EXPECT_GT(answer.normal.z, 0.9);
  }
}

// Normals are scaled to length 1 before they are summed, so the huge face does not dominate.
TEST(StabilityNormal, AcuteEdgeBetweenATinyAndAHugeFace) {
  const Soup wedge = tetrahedron({0, 0, 0}, {-1e6, 0.5, 1e5}, {0, 1, 0}, {-1e-3, 0.5, -1e-4});
  expect_normals(wedge, 1e-3, 300);
  BuiltModel model(wedge);
  const ClosestPoint answer = model.closest_point({1, 0.5, 0});
  EXPECT_EQ(answer.feature, Feature::kEdge);
  EXPECT_EQ(answer.side, Side::kOutside);
  EXPECT_GT(answer.normal.x, 0);
}

TEST(StabilityNormal, VertexOfAThousandFaces) {
  constexpr int kFaces = 1000;
  Soup cone;
  const auto rim = [](int i) {
    const double angle = 2 * std::numbers::pi * (i % kFaces) / kFaces;
    return Vec3{std::cos(angle), std::sin(angle), 0};
  };
  for (int i = 0; i < kFaces; ++i) {
    cone.push_back({Vec3{0, 0, 1}, rim(i), rim(i + 1)});
    cone.push_back({Vec3{0, 0, 0}, rim(i + 1), rim(i)});
  }
  BuiltModel model(cone, {4096, 1 << 20, 1});
  const ClosestPoint tip = model.closest_point({0.1, -0.2, 3});
  EXPECT_EQ(tip.feature, Feature::kVertex);
  expect_direction(tip.normal, {0, 0, 1});
  expect_direction(model.closest_point({0, 0, -2}).normal, {0, 0, -1});
}

// Half of the faces around the vertex lean one way, half the other.
TEST(StabilityNormal, SaddleVertex) {
  constexpr int kSides = 16;
  const auto rim = [](int i) {
    const double angle = 2 * std::numbers::pi * (i % kSides) / kSides;
    return Vec3{std::cos(angle), std::sin(angle), 0.5 * std::cos(2 * angle)};
  };
  Soup saddle;
  for (int i = 0; i < kSides; ++i) {
    saddle.push_back({Vec3{0, 0, 0}, rim(i), rim(i + 1)});
    saddle.push_back({Vec3{0, 0, -5}, rim(i + 1), rim(i)});
  }
  BuiltModel model(saddle);
  const ClosestPoint above = model.closest_point({0, 0, 0.1});
  EXPECT_EQ(above.side, Side::kOutside);
  EXPECT_GT(above.normal.z, 0.5);
  expect_normals(saddle, 0.3, 300);
}

// Splitting a flat face does not change its weight.
TEST(StabilityNormal, SubdividedFlatFace) {
  const Soup coarse = box({0, 0, 0}, {1, 1, 1});
  Soup fine;
  for (const Corners& t : coarse) {
    const Vec3 a = (t[0] + t[1]) * 0.5, b = (t[1] + t[2]) * 0.5, c = (t[2] + t[0]) * 0.5;
    fine = fine + Soup{{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}};
  }
  BuiltModel left(coarse), right(fine);
  for (const Vec3& query : {Vec3{2, 2, 2}, Vec3{-1, -2, -3}, Vec3{1.5, 0.3, 1.5}, Vec3{2, 2, -1}}) {
    const Vec3 found = right.closest_point(query).normal;
    expect_direction(left.closest_point(query).normal, found);
  }
  expect_direction(left.closest_point({2, 2, 2}).normal, {1, 1, 1});
}

// From farther than doubles can measure, normals are oriented as from nearby.
TEST(StabilityNormal, FarQueriesOfAnInsideOutModel) {
  const Soup solid = ball(2);
  BuiltModel outward(solid), inward(inside_out(solid));
  const Vec3 ways[] = {{1, 0.25, 0.125}, {-0.5, 1, 0.25}, {-0.25, -0.5, -1}};
  for (const Vec3& way : ways)
    for (const double far : {1e3, 1e80, 1e92, 1e200, 1e308}) {
      const ClosestPoint left = outward.closest_point(way * far),
                         right = inward.closest_point(way * far);
      EXPECT_GT(dot(left.normal, way), 0) << far;
      EXPECT_GT(dot(right.normal, way), 0) << far;
      EXPECT_EQ(left.side, Side::kOutside);
    }
}

// The sum is zero, so the first face decides.
TEST(StabilityNormal, OppositeDuplicateFaces) {
  const Corners face{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  const Corners back{face[0], face[2], face[1]};
  BuiltModel model({back, face});
  for (const Vec3& query : {Vec3{-1, -1, 1}, Vec3{0.5, -1, 1}}) {
    const ClosestPoint answer = model.closest_point(query);
    EXPECT_NE(answer.feature, Feature::kFace);
    EXPECT_EQ(std::fabs(answer.normal.z), 1);
    EXPECT_GT(answer.normal.z, 0);  // nothing is inside, so it points to the query
  }
}

TEST(StabilityNormal, EdgeOfThreeFaces) {
  const Vec3 a{0, 0, 0}, b{0, 0, 1};
  BuiltModel model({{a, b, Vec3{1, 0, 0}}, {a, b, Vec3{-1, 1, 0}}, {b, a, Vec3{-1, -1, 0}}});
  EXPECT_EQ(model.model().info().watertight(), false);
  expect_sound(model, {0.1, 0.2, 0.5});
  expect_sound(model, {-1, 0, 0.5});
}

// Both sides are outside, so the normal points to the query.
TEST(StabilityNormal, OpenBorder) {
  BuiltModel model({{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}});
  expect_direction(model.closest_point({-1, -1, 0.5}).normal, {0, 0, 1});
  expect_direction(model.closest_point({-1, -1, -0.5}).normal, {0, 0, -1});
}

TEST(StabilityNormal, FacesWithoutArea) {
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{2, 0, 0};
  BuiltModel model({{a, b, c}, {a, a, a}});
  expect_direction(model.closest_point({0.5, 1, 0}).normal, {0, 0, 1});
  expect_direction(model.closest_point({-1, 0, 0}).normal, {0, 0, 1});
}

}  // namespace
}  // namespace planetree::oracle
