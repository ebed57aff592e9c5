// Sides of surfaces that are not watertight: holes, reversed parts, soups, points on the surface,
// and work that runs out.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/differential/answer_checks.h"
#include "tests/oracle/closed_models.h"
#include "tests/oracle/random.h"
#include "tests/oracle/winding.h"

namespace planetree::oracle {
namespace {

Side side_of(BuiltModel& model, const Vec3& query) { return model.probe().contains(query).side; }

// A ball without the faces above a height.
Soup bowl(unsigned levels, double rim) {
  Soup faces = ball(levels);
  std::erase_if(faces, [&](const Corners& t) { return t[0].z + t[1].z + t[2].z > 3 * rim; });
  return faces;
}

void expect_sides(const Soup& triangles, int count, std::uint64_t seed = 1) {
  BuiltModel model(triangles, {4096, 1 << 20, 1});
  ASSERT_FALSE(model.model().info().watertight());
  Random random(seed);
  for (int i = 0; i < count; ++i) expect_side(model, nasty_query(random, triangles, 1));
}

// The boundary of the inside follows the hole inward: sides never jump, and the middle is inside
// until less than half of the sphere is left.
TEST(StabilityWinding, GrowingHole) {
  double depth_before = 2;
  for (double rim = 0.99; rim > -0.6; rim -= 0.15) {
    SCOPED_TRACE(rim);
    const Soup faces = bowl(4, rim);
    BuiltModel model(faces, {4096, 1 << 20, 1});
    ASSERT_FALSE(model.model().info().watertight());
    const long double middle = open_winding({0, 0, 0.001}, faces).value;
    EXPECT_EQ(side_of(model, {0, 0, 0.001}), middle > 0.5L ? Side::kInside : Side::kOutside);
    EXPECT_EQ(side_of(model, {0, 0, -0.97}), Side::kInside);
    EXPECT_EQ(side_of(model, {0, 0, -1.03}), Side::kOutside);
    EXPECT_EQ(side_of(model, {0, 0, 1.03}), Side::kOutside);
    // Down the axis the side changes once.
    int changes = 0;
    double depth = 2;
    Side side = Side::kOutside;
    for (double z = 1.2; z > -0.99; z -= 0.01) {
      const Side now = side_of(model, {0.001, 0.002, z});
      changes += now != side;
      if (now != side) depth = z;
      side = now;
    }
    EXPECT_EQ(changes, 1);
    EXPECT_LE(depth, depth_before);
    depth_before = depth;
    expect_sides(faces, 40);
  }
}

// A part with reversed faces counts against the rest, and only near it.
TEST(StabilityWinding, PartWithReversedFaces) {
  Soup faces = ball(4);
  for (Corners& t : faces)
    if (t[0].z + t[1].z + t[2].z > 3 * 0.9) std::swap(t[0], t[1]);
  BuiltModel model(faces, {4096, 1 << 20, 1});
  EXPECT_FALSE(model.model().info().watertight());
  EXPECT_EQ(side_of(model, {0, 0, 0}), Side::kInside);
  EXPECT_EQ(side_of(model, {0, 0, -0.98}), Side::kInside);
  EXPECT_EQ(side_of(model, {0.98, 0, 0}), Side::kInside);
  EXPECT_EQ(side_of(model, {0, 0, 1.5}), Side::kOutside);
  expect_sides(faces, 300);
}

// Inside out, the surface encloses the same points.
TEST(StabilityWinding, InsideOutBowl) {
  const Soup faces = bowl(3, 0.7);
  BuiltModel model(faces), reversed(inside_out(faces));
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Vec3 query = random.in_cube() * 1.2;
    EXPECT_EQ(side_of(model, query), side_of(reversed, query));
    const Vec3 normal = model.closest_point(query).normal,
               other = reversed.closest_point(query).normal;
    EXPECT_EQ(normal.x, other.x);
    EXPECT_EQ(normal.y, other.y);
    EXPECT_EQ(normal.z, other.z);
  }
}

// Solid angles are 0 / 0 there.
TEST(StabilityWinding, OnATriangle) {
  const Soup faces = bowl(3, 0.7);
  BuiltModel model(faces);
  for (const Corners& t : faces) {
    for (const Vec3& corner : t) EXPECT_EQ(side_of(model, corner), Side::kOnSurface);
    const ClosestPoint answer = model.closest_point(t[0]);
    EXPECT_EQ(answer.distance, 0);
    const Vec3 normal = answer.normal;
    EXPECT_GT(normal.x * t[0].x + normal.y * t[0].y + normal.z * t[0].z, 0.5);
  }
  BuiltModel one(Soup{{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}});
  const double least = std::numeric_limits<double>::denorm_min(), small = 0x1p-30;
  EXPECT_EQ(side_of(one, {0.25, 0.5, 0}), Side::kOnSurface);
  EXPECT_EQ(side_of(one, {0.5, 0, 0}), Side::kOnSurface);
  // One half minus the smallest double cannot be distinguished from one half.
  EXPECT_EQ(side_of(one, {0.25, 0.5, least}), Side::kUnknown);
  EXPECT_EQ(side_of(one, {0.25, 0.5, small}), Side::kOutside);
  EXPECT_EQ(side_of(one, {0.25, 0.5, -small}), Side::kOutside);
  EXPECT_EQ(side_of(one, {0.5, -least, 0}), Side::kOutside);
  EXPECT_EQ(side_of(one, {2, 0, 0}), Side::kOutside);
}

// One face twice gives a winding number of one just above and just below it.
TEST(StabilityWinding, BesideADoubledFace) {
  const Corners face = {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  BuiltModel two(Soup{face, face});
  EXPECT_EQ(side_of(two, {0.3, 0.3, 0x1p-1000}), Side::kInside);
  EXPECT_EQ(side_of(two, {0.3, 0.3, -0x1p-1000}), Side::kInside);
  EXPECT_EQ(side_of(two, {0.3, 0.3, 10}), Side::kOutside);
}

// However little work is allowed, a known side is true. More work makes more sides known.
TEST(StabilityWinding, LimitedWork) {
  const Soup faces = bowl(4, 0.3);
  BuiltModel model(faces);
  const ModelInfo& info = model.model().info();
  Random random(37);
  std::vector<Vec3> queries;
  for (int i = 0; i < 60; ++i) queries.push_back(random.in_cube() * 1.1);
  std::size_t certain_before = 0;
  // Up to the moments of every node and the solid angles of every triangle.
  const std::uint64_t all = 3 * info.nodes + info.blocks + info.triangles;
  for (std::uint32_t units = 1; units < 2 * all; units *= 2) {
    std::size_t certain = 0;
    for (const Vec3& query : queries) {
      const Containment found = model.probe().contains(query, {.max_work = units});
      ASSERT_EQ(found.side == Side::kUnknown, found.status == Status::kDegraded);
      if (found.side == Side::kUnknown) continue;
      ++certain;
      const long double w = std::fabs(open_winding(query, faces).value);
      EXPECT_EQ(found.side, w > 0.5L ? Side::kInside : Side::kOutside) << units;
    }
    EXPECT_GE(certain, certain_before);
    certain_before = certain;
  }
  EXPECT_EQ(certain_before, queries.size());
}

// Octants of a sphere whose solid angles sum to one half: no side can be decided.
TEST(StabilityWinding, ExactlyOneHalf) {
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Soup faces(20, {x, y, z});
  faces.insert(faces.end(), 16, {z, y, x});
  BuiltModel model(faces);
  const Containment found = model.probe().contains({0, 0, 0});
  EXPECT_EQ(found.side, Side::kUnknown);
  EXPECT_EQ(found.status, Status::kDegraded);
}

TEST(StabilityWinding, FarQueries) {
  BuiltModel model(bowl(3, 0.0));
  for (const double far : {1.5, 1e10, 1e100, 1e300, 1e308, -1e308}) {
    EXPECT_EQ(side_of(model, {far, 0, 0}), Side::kOutside);
    EXPECT_EQ(model.closest_point({0, 0, far}).side, Side::kOutside);
  }
}

// No side of any soup is wrong, however near and however small.
TEST(StabilityWinding, NastyModels) {
  for (const NastyFamily& family : nasty_families())
    for (int i = 0; i < static_cast<int>(3 * test_effort()); ++i) {
      Random random(2000 + static_cast<std::uint64_t>(i));
      SCOPED_TRACE(std::string(family.name) + " model " + std::to_string(i));
      constexpr int kExponents[] = {0, -996, 500};
      const double size = std::ldexp(1.0, kExponents[i % 3]);
      BuiltModel model(scaled(family.make(random), size), {4096, 1 << 20, 1});
      for (int k = 0; k < 50 && !testing::Test::HasFailure(); ++k)
        expect_side(model, nasty_query(random, model.triangles(), size));
    }
}

}  // namespace
}  // namespace planetree::oracle
