#include "octree/builder/sort/core_box.h"

#include <gtest/gtest.h>

#include <cmath>

#include "octree/builder/sort/morton_order.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

// A triangle with a corner at `at` and edges along the axes.
std::array<Vec3, 3> triangle_at(const Vec3& at, double edge) {
  return {at, Vec3{at.x + edge, at.y, at.z}, Vec3{at.x, at.y + edge, at.z}};
}

std::uint64_t strays_of(const Soup& soup) { return store(soup).frame.stray_count; }

// A sphere of 512 triangles and radius 1, and one triangle more.
Soup sphere_and(const std::array<Vec3, 3>& stray) {
  Soup soup = sphere(3);
  soup.push_back(stray);
  return soup;
}

TEST(CoreFinder, TakesModelsWithoutStraysAsAWhole) {
  for (const Soup& soup : {Soup(sphere(3)), Soup(sphere(0)), Soup(scattered(1000, 1e-3))}) {
    const ModelFrame frame = store(soup).frame;
    EXPECT_EQ(frame.stray_count, 0u);
    EXPECT_EQ(frame.core_lower(), frame.lower());
    EXPECT_EQ(frame.core_upper(), frame.upper());
  }
}

TEST(CoreFinder, FindsAStrayOnEverySide) {
  for (const double far : {1e3, 1e8, 1e15, 1e30})
    for (int side = 0; side < 6; ++side) {
      std::array<double, 3> at{0.1, 0.2, 0.3};
      at[static_cast<std::size_t>(side / 2)] = side % 2 == 0 ? far : -far;
      const SampleMesh mesh = store(sphere_and(triangle_at({at[0], at[1], at[2]}, 0.01 * far)));
      EXPECT_EQ(mesh.frame.stray_count, 1u);
      EXPECT_EQ(mesh.frame.stray_edge, 0);
      EXPECT_EQ(mesh.frame.core_lower(), store(sphere(3)).frame.lower());
      EXPECT_EQ(mesh.frame.core_upper(), store(sphere(3)).frame.upper());
      EXPECT_EQ(mesh.frame.scale_exponent, store(sphere(3)).frame.scale_exponent);
    }
}

TEST(CoreFinder, MarksTheCodesOfStraysAlone) {
  Soup soup = sphere_and(triangle_at({-1e6, 5, 7}, 1));
  soup.insert(soup.begin() + 100, triangle_at({3, 1e9, 7}, 1));
  const SampleMesh mesh = store(soup);
  ASSERT_EQ(mesh.frame.stray_count, 2u);
  for (std::uint32_t i = 0; i < mesh.size(); ++i) {
    EXPECT_EQ(is_stray(mesh.code(i)), mesh.index(i) == 100 || mesh.index(i) == 513);
    EXPECT_LT(morton_part(mesh.code(i)), kStrayCode);
  }
}

TEST(CoreFinder, FindsTheCoreFarFromTheOrigin) {
  Soup soup = sphere(3);
  for (auto& triangle : soup)
    for (Vec3& corner : triangle) corner = {corner.x + 6e6, corner.y - 5e5, corner.z};
  soup.push_back(triangle_at({0, 0, 0}, 1));
  EXPECT_EQ(strays_of(soup), 1u);
}

TEST(CoreFinder, StatesTheEdgeOfATriangleThatReachesFarOut) {
  const SampleMesh mesh = store(sphere_and({Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{1e4, 1e4, 1e4}}));
  EXPECT_EQ(mesh.frame.stray_count, 1u);
  const double longest = (mesh.frame.upper() - mesh.frame.lower()).norm();
  EXPECT_GE(mesh.frame.stray_edge, longest * (1 - 1e-12));
  EXPECT_LE(mesh.frame.stray_edge, 2 * longest);
}

// Bounds are relative to edges as well, and would say nothing.
TEST(CoreFinder, KeepsNoStrayThatReachesTooFarOut) {
  EXPECT_EQ(strays_of(sphere_and({Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{1e9, 1e9, 1e9}})), 0u);
}

TEST(CoreFinder, KeepsNoStraysThatAreManyOrNear) {
  Soup many = sphere(3);
  for (int i = 0; i < 9; ++i) many.push_back(triangle_at({1e6 + i, 0, 0}, 1));
  EXPECT_EQ(strays_of(many), 0u);
  many.resize(many.size() - 1);
  EXPECT_EQ(strays_of(many), 8u);
  EXPECT_EQ(strays_of(sphere_and(triangle_at({3, 0, 0}, 1))), 0u);
  EXPECT_EQ(strays_of({triangle_at({0, 0, 0}, 1), triangle_at({1e6, 0, 0}, 1)}), 0u);
}

// Its square would not be a double.
TEST(CoreFinder, KeepsNoStrayBeyondTheLimitOfCoordinates) {
  EXPECT_EQ(strays_of(sphere_and(triangle_at({1e40, 0, 0}, 1e38))), 0u);
  EXPECT_EQ(strays_of(sphere_and(triangle_at({1e300, 0, 0}, 1e290))), 0u);
}

// The sample has one triangle of many, from everywhere in the input.
TEST(CornerSample, IsSpreadOverAllThatIsAdded) {
  CornerSample sample;
  constexpr int kCount = 1000000;
  for (int i = 0; i < kCount; ++i) sample.add({i * 1.0, -i * 1.0, 7});
  CornerSample::Middle middle{Point::Zero(), Point::Zero()};
  ASSERT_TRUE(sample.middle(middle));
  EXPECT_NEAR(middle.lower.x(), kCount / 64.0, kCount / 1e3);
  EXPECT_NEAR(middle.upper.x(), kCount - kCount / 64.0, kCount / 1e3);
  EXPECT_NEAR(middle.upper.y(), -kCount / 64.0, kCount / 1e3);
  EXPECT_EQ(middle.lower.z(), 7);
}

TEST(CornerSample, HasNoMiddleOfAFewTriangles) {
  CornerSample sample;
  CornerSample::Middle middle{Point::Zero(), Point::Zero()};
  for (int i = 0; i < 63; ++i) sample.add({i * 1.0, 0, 0});
  EXPECT_FALSE(sample.middle(middle));
  sample.add({1, 0, 0});
  EXPECT_TRUE(sample.middle(middle));
}

}  // namespace
}  // namespace planetree::octree
