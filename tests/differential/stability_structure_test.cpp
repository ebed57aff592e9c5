// Models whose overall shape strains the tree.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "octree/nearest/nearest.h"
#include "tests/differential/answer_checks.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/random.h"

namespace planetree::oracle {
namespace {

void expect_sound_around(BuiltModel& model, double size, int queries) {
  Random random(23);
  for (int i = 0; i < queries && !testing::Test::HasFailure(); ++i)
    expect_sound(model, nasty_query(random, model.triangles(), size));
}

Soup scattered(Random& random, int count, double size) {
  Soup triangles;
  for (int i = 0; i < count; ++i) {
    const Vec3 at = random.in_cube();
    triangles.push_back({at, at + random.in_cube() * size, at + random.in_cube() * size});
  }
  return triangles;
}

// Corners on the lines where cells of every level meet, and on the outermost one.
TEST(StabilityStructure, CellBordersAndTheLastCorner) {
  Soup triangles;
  for (int x = 0; x <= 8; ++x)
    for (int y = 0; y <= 8; ++y) {
      const Vec3 at{x / 8.0, y / 8.0, ((x + y) % 9) / 8.0};
      triangles.push_back({at, {1, 1, 1}, {at.x, at.y, 1}});
    }
  BuiltModel model(triangles, {4096, 1 << 20, 1});
  for (int x = -1; x <= 17; x += 2)
    for (int y = 0; y <= 16; y += 4)
      for (int z = 0; z <= 16; z += 4) expect_sound(model, {x / 16.0, y / 16.0, z / 16.0});
  expect_sound(model, {1, 1, 1});
}

// A box without thickness, along each axis.
TEST(StabilityStructure, FlatModel) {
  for (int axis = 0; axis < 3; ++axis) {
    Random random(9);
    Soup triangles = scattered(random, 200, 0.1);
    for (Corners& triangle : triangles)
      for (Vec3& p : triangle) (axis == 0 ? p.x : axis == 1 ? p.y : p.z) = 0.3;
    BuiltModel model(triangles);
    expect_sound_around(model, 1, 100);
  }
}

// One triangle as large as the model among many small ones.
TEST(StabilityStructure, OneTriangleOverAllCells) {
  Random random(10);
  Soup triangles = scattered(random, 300, 0.01);
  triangles.push_back({Vec3{-1, -1, -1}, Vec3{1, -1, 1}, Vec3{0, 1, 0.1}});
  BuiltModel model(triangles, {4096, 1 << 20, 1});
  expect_sound_around(model, 0.5, 200);
}

// A million copies of one triangle. Every copy is as near as the first, which must be named, and
// evaluating them must not repeat work.
TEST(StabilityStructure, MillionCoincidentTriangles) {
  const Corners triangle{Vec3{0.1, 0.2, 0.3}, Vec3{1.1, 0.3, 0.2}, Vec3{0.4, 1.3, 0.9}};
  BuiltModel model(Soup(1000000, triangle));
  const ModelInfo& info = model.model().info();
  EXPECT_EQ(info.triangles, 1000000U);
  EXPECT_LE(info.levels, 20U);
  ClosestPoint answer;
  for (const Vec3& query : {Vec3{0, 0, 0}, Vec3{0.5, 0.5, 0.5}, Vec3{9, 9, 9}}) {
    answer = model.closest_point(query, {.parts = kDistance});
    EXPECT_EQ(answer.triangle, 0U);
    EXPECT_EQ(answer.status, Status::kExact);
    const Wide truth = exact_distance(query, std::span(&triangle, 1));
    EXPECT_LE(Wide(answer.lower), truth);
    EXPECT_LE(truth, Wide(answer.upper));
  }
  expect_same_bits(answer, model.closest_point({9, 9, 9}, {.parts = kDistance}));
  const Stats stats = model.model().stats();
  EXPECT_LE(stats.page_misses, 2 * info.pages);
}

// A fine part and a coarse part: no mean edge length describes both.
TEST(StabilityStructure, EdgeLengthsOfTwoScales) {
  Random random(11);
  Soup triangles = translated(scaled(scattered(random, 300, 0.1), 1e-7), {0.4, 0.5, 0.6});
  for (const Corners& triangle : scattered(random, 100, 1)) triangles.push_back(triangle);
  BuiltModel model(triangles, {4096, 1 << 20, 1});
  expect_sound_around(model, 1e-7, 100);
  expect_sound_around(model, 1, 100);
}

// A model no larger than an atom is answered like any other.
TEST(StabilityStructure, TinyDimensions) {
  Random random(12);
  BuiltModel model(scaled(scattered(random, 200, 0.2), 1e-12));
  expect_sound_around(model, 1e-12, 200);
}

// Clusters within clusters, each half as far from a corner as the one before, down to where cells
// no longer separate triangles.
TEST(StabilityStructure, DepthLimitReached) {
  Random random(13);
  Soup triangles{{Vec3{1, 1, 1}, Vec3{0.9, 1, 1}, Vec3{1, 0.9, 1}}};
  for (int level = 0; level < 30; ++level)
    for (int i = 0; i < 12; ++i) {
      const double size = std::ldexp(1.0, -level);
      const Vec3 at = Vec3{1, 1, 1} * size + random.in_cube() * (0.01 * size);
      triangles.push_back(
          {at, at + random.in_cube() * (0.1 * size), at + random.in_cube() * (0.1 * size)});
    }
  for (int i = 0; i < 140; ++i) {
    const auto speck = [&] { return random.in_cube() * 0x1p-30; };
    triangles.push_back({speck(), speck(), speck()});
  }
  BuiltModel model(triangles, {4096, 1 << 20, 1});
  EXPECT_LT(model.model().info().levels, octree::kMaxHeight);
  expect_sound_around(model, 0x1p-30, 100);
  expect_sound_around(model, 1, 100);
}

// Planes a few ulps apart, parallel up to rounding.
TEST(StabilityStructure, PlanesNearlyEqual) {
  Random random(14);
  Soup triangles;
  for (int i = 0; i < 300; ++i) {
    const double height = 0.5 + 0x1p-53 * static_cast<double>(random.below(8));
    const auto corner = [&] { return Vec3{random.unit(), random.unit(), height}; };
    triangles.push_back({corner(), corner(), corner()});
  }
  BuiltModel model(triangles, {4096, 1 << 20, 1});
  expect_sound_around(model, 0.1, 200);
  expect_sound_around(model, 1e-15, 200);
}

// The smallest model.
TEST(StabilityStructure, OneTriangle) {
  BuiltModel model({{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}});
  EXPECT_EQ(model.model().info().blocks, 1U);
  EXPECT_EQ(model.model().info().nodes, 0U);
  expect_sound_around(model, 1, 100);
}

// An empty model is refused with a message.
TEST(StabilityStructure, EmptyModelIsRefused) {
  EXPECT_NE(build_failure({}).find("no triangle"), std::string::npos);
}

// Counts of triangles around the sizes at which a block or node is split.
TEST(StabilityStructure, CountsAroundBlockAndNodeSizes) {
  for (const int count : {1, 2, 15, 16, 17, 31, 32, 33, 127, 128, 129, 130, 256, 257}) {
    Random random(15);
    BuiltModel model(scattered(random, count, 0.3), {4096, 1 << 20, 1});
    expect_sound_around(model, 1, 30);
  }
}

}  // namespace
}  // namespace planetree::oracle
