// Sides that careless arithmetic gets wrong: lattices, shells, contact, points on the surface and
// an ulp beside it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/differential/answer_checks.h"
#include "tests/oracle/closed_models.h"
#include "tests/oracle/random.h"

namespace planetree::oracle {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Side side_of(BuiltModel& model, const Vec3& query) { return model.probe().contains(query).side; }

// Queries a watertight model with every kind of nasty_query().
void expect_sides(const Soup& triangles, int count, std::uint64_t seed = 1) {
  BuiltModel model(triangles, {4096, 1 << 20, 1});
  ASSERT_TRUE(model.model().info().watertight());
  Random random(seed);
  for (int i = 0; i < count; ++i) expect_side(model, nasty_query(random, triangles, 1));
}

// Every ray along an axis meets edges and corners, or lies within a face.
TEST(StabilitySide, LatticeQueriesOfACube) {
  BuiltModel cube(box({0, 0, 0}, {1, 1, 1}));
  for (int x = -1; x <= 5; ++x)
    for (int y = -1; y <= 5; ++y)
      for (int z = -1; z <= 5; ++z) {
        const auto [least, greatest] = std::minmax({x, y, z});
        const Side expected = least < 0 || greatest > 4     ? Side::kOutside
                              : least == 0 || greatest == 4 ? Side::kOnSurface
                                                            : Side::kInside;
        const Vec3 query{x * 0.25, y * 0.25, z * 0.25};
        EXPECT_EQ(side_of(cube, query), expected) << x << ' ' << y << ' ' << z;
        EXPECT_EQ(cube.closest_point(query).side, expected);
      }
}

TEST(StabilitySide, NestedShells) {
  const Soup hollow = ball(2) + scaled(inside_out(ball(2)), 0.5);
  BuiltModel model(hollow);
  EXPECT_EQ(side_of(model, {0.75, 0, 0}), Side::kInside);
  EXPECT_EQ(side_of(model, {0.25, 0, 0}), Side::kOutside);
  expect_sides(hollow, 200);
  expect_sides(ball(2) + scaled(ball(2), 0.5), 200);
}

TEST(StabilitySide, TouchingShells) {
  const Soup two = box({0, 0, 0}, {1, 1, 1}) + box({1, 0, 0}, {2, 1, 1});
  BuiltModel model(two);
  EXPECT_EQ(side_of(model, {1, 0.5, 0.5}), Side::kOnSurface);
  EXPECT_EQ(side_of(model, {1.5, 0.5, 0.5}), Side::kInside);
  expect_sides(two, 200);
}

TEST(StabilitySide, SelfIntersection) {
  const Soup crossed = tetrahedron({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0.2, 0.3, 1}) +
                       tetrahedron({0, 0, 0.5}, {0, 1, 0.4}, {1, 0, 0.6}, {0.3, 0.2, -1});
  expect_sides(crossed, 300);
}

// A winding number of 2 is as inside as 1.
TEST(StabilitySide, DuplicatedModel) {
  BuiltModel model(ball(2) + ball(2));
  EXPECT_EQ(side_of(model, {0, 0, 0}), Side::kInside);
  expect_sides(ball(2) + ball(2), 200);
}

TEST(StabilitySide, InsideOutModel) {
  BuiltModel model(inside_out(ball(2)));
  EXPECT_EQ(side_of(model, {0, 0, 0}), Side::kInside);
  EXPECT_EQ(side_of(model, {1.1, 0, 0}), Side::kOutside);
  EXPECT_LT(model.closest_point({0, 0, 0}).signed_distance(), 0);
  EXPECT_GT(model.closest_point({2, 0, 0}).signed_distance(), 0);
  expect_sides(inside_out(ball(2)), 200);
}

// Faces that cancel each other enclose nothing.
TEST(StabilitySide, OppositeDuplicateFaces) {
  const Soup nothing = ball(1) + inside_out(ball(1));
  BuiltModel model(nothing);
  EXPECT_EQ(side_of(model, {0, 0, 0}), Side::kOutside);
  expect_sides(nothing, 100);
}

TEST(StabilitySide, ShrinkingGap) {
  for (int exponent = -1; exponent >= -52; exponent -= 3) {
    const double gap = std::ldexp(1.0, exponent);
    const Soup two = box({0, 0, 0}, {1, 1, 1}) + box({1 + gap, 0, 0}, {2, 1, 1});
    BuiltModel model(two);
    EXPECT_EQ(side_of(model, {1 + gap / 2, 0.5, 0.5}),
              1 + gap / 2 > 1 ? Side::kOutside : Side::kOnSurface)
        << exponent;
    EXPECT_EQ(side_of(model, {std::nextafter(1.0, 0.0), 0.5, 0.5}), Side::kInside);
    EXPECT_EQ(side_of(model, {std::nextafter(1 + gap, 2.0), 0.5, 0.5}), Side::kInside);
  }
}

TEST(StabilitySide, ExactlyOnTheSurface) {
  Random random(33);
  const Soup solid = tetrahedron({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1});
  BuiltModel model(solid);
  for (int i = 0; i < 200; ++i) {
    // Few bits, so that the plane contains the point exactly.
    const double u = static_cast<double>(random.below(17)) / 16;
    const double v = static_cast<double>(random.below(17)) / 16 * (1 - u);
    EXPECT_EQ(side_of(model, {u, v, 1 - u - v}), Side::kOnSurface);
    EXPECT_EQ(side_of(model, {u, v, 0}), Side::kOnSurface);
    EXPECT_EQ(side_of(model, {0, u, v}), Side::kOnSurface);
  }
  for (const Vec3& corner : solid[2]) EXPECT_EQ(side_of(model, corner), Side::kOnSurface);
}

TEST(StabilitySide, UlpGridAboutAFace) {
  const Soup solid = tetrahedron({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1});
  BuiltModel model(solid);
  int on = 0;
  for (int x = -3; x <= 3; ++x)
    for (int y = -3; y <= 3; ++y)
      for (int z = -3; z <= 3; ++z) {
        const Vec3 query{0.25 + x * 0x1p-54, 0.25 + y * 0x1p-54, 0.5 + z * 0x1p-53};
        const int beyond = x + y + 2 * z;
        const Side expected = beyond > 0    ? Side::kOutside
                              : beyond == 0 ? Side::kOnSurface
                                            : Side::kInside;
        EXPECT_EQ(side_of(model, query), expected);
        on += expected == Side::kOnSurface;
      }
  EXPECT_GT(on, 10);
}

// A model and a lattice whose unit is the smallest double.
TEST(StabilitySide, NearTheSmallestNumbers) {
  const double unit = 0x1p-1074;
  const auto at = [unit](int x, int y, int z) { return Vec3{x * unit, y * unit, z * unit}; };
  BuiltModel model(tetrahedron(at(0, 0, 0), at(0, 4, 0), at(4, 0, 0), at(0, 0, 4)));
  ASSERT_TRUE(model.model().info().watertight());
  int inside = 0;
  for (int x = -1; x <= 5; ++x)
    for (int y = -1; y <= 5; ++y)
      for (int z = -1; z <= 5; ++z) {
        const int least = std::min({x, y, z}), sum = x + y + z;
        const Side expected = least < 0 || sum > 4     ? Side::kOutside
                              : least == 0 || sum == 4 ? Side::kOnSurface
                                                       : Side::kInside;
        EXPECT_EQ(side_of(model, at(x, y, z)), expected) << x << ' ' << y << ' ' << z;
        EXPECT_EQ(expect_sound(model, at(x, y, z)).side, expected);
        inside += expected == Side::kInside;
      }
  EXPECT_EQ(inside, 1);
}

// Outside, and almost in the plane of a face.
TEST(StabilitySide, NearlyCoplanarOutside) {
  const Soup solid = tetrahedron({0, 0, 0}, {0, 1, 1e-9}, {1, 0, 1e-9}, {0.2, 0.2, 1});
  BuiltModel model(solid);
  Random random(34);
  for (int i = 0; i < 300; ++i)
    expect_side(model, {random.between(-0.5, 1.5), random.between(-0.5, 1.5),
                        random.signed_magnitude(-60, -28)});
}

TEST(StabilitySide, CentreOfASphere) {
  for (unsigned levels = 0; levels < 4; ++levels) {
    BuiltModel model(ball(levels));
    EXPECT_EQ(side_of(model, {0, 0, 0}), Side::kInside);
    EXPECT_EQ(model.closest_point({0, 0, 0}).side, Side::kInside);
  }
}

TEST(StabilitySide, FarQueries) {
  BuiltModel model(ball(2));
  for (const double far : {1.5, 1e10, 1e100, 1e300, 1e308, -1e308}) {
    EXPECT_EQ(side_of(model, {far, 0, 0}), Side::kOutside);
    EXPECT_EQ(model.closest_point({0, far, 0}).side, Side::kOutside);
  }
  EXPECT_EQ(side_of(model, {kInfinity, 0, 0}), Side::kUnknown);
  EXPECT_EQ(model.probe().contains({0, kInfinity, 0}).status, Status::kBadQuery);
}

// PLANETREE_TEST_EFFORT in the environment multiplies the number of models.
TEST(StabilitySide, NastyWatertightModels) {
  for (const NastyFamily& family : closed_families())
    for (int i = 0; i < static_cast<int>(4 * test_effort()); ++i) {
      Random random(1000 + static_cast<std::uint64_t>(i));
      SCOPED_TRACE(std::string(family.name) + " model " + std::to_string(i));
      constexpr int kExponents[] = {0, -996, 500, 37};
      const double size = std::ldexp(1.0, kExponents[i % 4]);
      BuiltModel model(scaled(family.make(random), size), {4096, 1 << 20, 1});
      ASSERT_TRUE(model.model().info().watertight());
      for (int k = 0; k < 60 && !testing::Test::HasFailure(); ++k) {
        const Vec3 query = nasty_query(random, model.triangles(), size);
        if (k % 3 == 0) expect_sound(model, query);
        expect_side(model, query);
      }
    }
}

}  // namespace
}  // namespace planetree::oracle
