// Points that are equally far from many triangles: axes, centres, medial planes.

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "tests/differential/answer_checks.h"
#include "tests/oracle/closed_models.h"

namespace planetree::oracle {
namespace {

constexpr std::size_t kSides = 48;

Vec3 rim(std::size_t i, double z) {
  const auto [x, y] = on_circle(static_cast<double>(i % kSides) / kSides);
  return {x, y, z};
}

// A closed cylinder of radius 1 from z = -1 to 1, or a cone with its tip at the top.
Soup upright(bool cone) {
  const auto top = [cone](std::size_t i) { return cone ? Vec3{0, 0, 1} : rim(i, 1); };
  Soup soup;
  for (std::size_t i = 0; i < kSides; ++i) {
    soup.push_back({Vec3{0, 0, -1}, rim(i + 1, -1), rim(i, -1)});
    soup.push_back({rim(i, -1), rim(i + 1, -1), top(i)});
    if (cone) continue;
    soup.push_back({rim(i + 1, -1), top(i + 1), top(i)});
    soup.push_back({Vec3{0, 0, 1}, top(i), top(i + 1)});
  }
  return soup;
}

// Queries on the axis, where every side is equally far, on the rim, and where ends meet sides.
void expect_sound_about_the_axis(const Soup& soup) {
  BuiltModel model(soup, {4096, 1 << 20, 1});
  ASSERT_TRUE(model.model().info().watertight());
  for (int step = -24; step <= 24; step += 3) {
    const double z = step / 16.0;
    expect_sound(model, {0, 0, z});
    for (std::size_t i = 0; i < kSides; i += 15) {
      const Vec3 at = rim(i, 0);
      for (const double radius : {0x1p-60, 0.25, 0.5, 1.0, 2.0})
        expect_sound(model, {at.x * radius, at.y * radius, z});
    }
  }
}

TEST(StabilityTies, Sphere) {
  const Soup soup = ball(2);
  BuiltModel model(soup, {4096, 1 << 20, 1});
  expect_sound(model, {0, 0, 0});
  for (std::size_t i = 0; i < soup.size(); i += 3) {
    const Corners& triangle = soup[i];
    expect_sound(model, (triangle[0] + triangle[1]) * 0.25);
    expect_sound(model, triangle[0] * 0x1p-52);
    expect_sound(model, triangle[0] * 2);
  }
}

TEST(StabilityTies, Cylinder) { expect_sound_about_the_axis(upright(false)); }

TEST(StabilityTies, Cone) { expect_sound_about_the_axis(upright(true)); }

// The centre is 1 / sqrt(3) from all faces of an octahedron, and half from all of a cube, whose
// first triangle is named.
TEST(StabilityTies, CentreOfASphereAndOfACube) {
  BuiltModel octahedron(ball(0));
  const ClosestPoint answer = expect_sound(octahedron, {0, 0, 0});
  EXPECT_EQ(answer.side, Side::kInside);
  EXPECT_EQ(answer.feature, Feature::kFace);
  EXPECT_LE(answer.lower * answer.lower, 1 / 3.0);
  EXPECT_GE(answer.upper * answer.upper, 1 / 3.0);
  BuiltModel cube(box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  const ClosestPoint middle = expect_sound(cube, {0, 0, 0});
  EXPECT_EQ(middle.distance, 0.5);
  EXPECT_EQ(middle.triangle, 0u);
  EXPECT_EQ(middle.side, Side::kInside);
  EXPECT_EQ(middle.signed_distance(), -0.5);
}

// The medial surface of a box: the planes through its edges that halve their angles. Two or three
// faces are equally far, and a step off decides between them.
TEST(StabilityTies, MedialSurfaceOfABox) {
  BuiltModel model(box({0, 0, 0}, {1, 2, 4}));
  for (int i = 1; i <= 8; ++i) {
    const double t = i / 16.0;
    for (const Vec3& query : {Vec3{t, t, 2}, Vec3{t, t, t}, Vec3{1 - t, t, 1}, Vec3{0.5, 1, 4 - t},
                              Vec3{0.5, 1, 2}, Vec3{t, 2 - t, 4 - t}}) {
      EXPECT_EQ(expect_sound(model, query).side, Side::kInside);
      for (const double step : {0x1p-53, -0x1p-53, 0x1p-30, -0x1p-30})
        expect_sound(model, query + Vec3{0, step, 0});
    }
    EXPECT_EQ(model.closest_point({t, t, t}).distance, t);
  }
  // One step nearer to one face than to the other gives that face.
  EXPECT_EQ(model.closest_point({0.25, 0.25 - 0x1p-54, 2}).normal.y, -1);
  EXPECT_EQ(model.closest_point({0.25 - 0x1p-54, 0.25, 2}).normal.x, -1);
}

// Outside, between two solids.
TEST(StabilityTies, MidwayBetweenTwoSolids) {
  BuiltModel model(box({0, 0, 0}, {1, 1, 1}) + box({2, 0, 0}, {3, 1, 1}));
  for (int y = -2; y <= 6; ++y) expect_sound(model, {1.5, y / 4.0, 0.5});
  EXPECT_EQ(model.closest_point({1.5, 0.5, 0.5}).point.x, 1);  // the first solid
  EXPECT_EQ(model.closest_point({1.5 + 0x1p-52, 0.5, 0.5}).normal.x, -1);
  EXPECT_EQ(model.closest_point({1.5 - 0x1p-52, 0.5, 0.5}).normal.x, 1);
}

}  // namespace
}  // namespace planetree::oracle
