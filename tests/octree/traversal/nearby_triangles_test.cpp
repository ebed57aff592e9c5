#include "octree/traversal/nearby_lists.h"

#include <gtest/gtest.h>

#include <vector>

#include "octree/traversal/overlap.h"
#include "tests/octree/support/each_target.h"

namespace planetree::octree {
namespace {

Triangle triangle_at(double x) { return {Point(x, 0, 0), Point(x + 1, 0, 0), Point(x, 1, 0)}; }

// A triangle with the given distance from the centre.
NearbyTriangle found_at(double x, std::uint64_t id, double distance = 0) {
  return {triangle_at(x), id, distance};
}

NearbyTriangles listed(const std::vector<NearbyTriangle>& found, const Point& centre) {
  NearbyTriangles list;
  list.fill(found, centre, 0, 1);
  return list;
}

TEST(NearbyTriangles, KeepsCornersExactly) {
  const auto list = listed({found_at(1.0 / 3, 7)}, Point(0.1, 0.2, 0.3));
  EXPECT_TRUE(list.complete());
  EXPECT_EQ(list.size(), 1u);
  EXPECT_EQ(list.triangle(0), triangle_at(1.0 / 3));
  EXPECT_EQ(list.id(0), 7u);
}

TEST(NearbyTriangles, ExtentCoversTheFarthestCorner) {
  const auto list = listed({found_at(2, 0)}, Point(0, 0, 4));
  EXPECT_GE(list.extent(), 5);
  EXPECT_LE(list.extent(), 5.0001);
}

TEST(NearbyTriangles, RepeatsTheLastTriangleUpToAWholeVector) {
  const auto list = listed({found_at(1, 0), found_at(2, 1)}, Point(0.5, 0, 0));
  EXPECT_EQ(list.row(0, 0)[0], 0.5f);
  EXPECT_EQ(list.row(1, 0)[1], 2.5f);
  for (std::size_t i = 2; i < 8; ++i) {
    EXPECT_EQ(list.row(0, 0)[i], list.row(0, 0)[1]) << i;
    EXPECT_EQ(list.triangle(i), list.triangle(1)) << i;
  }
}

TEST(NearbyTriangles, CountWithinCoversAllNearTriangles) {
  std::vector<NearbyTriangle> found;
  for (unsigned i = 0; i < NearbyTriangles::kMax; ++i)
    found.push_back(found_at(i, i, (i * 37 % 64) / 64.0));
  const auto list = listed(found, Point::Zero());
  for (const double distance : {0.0, 0.1, 0.5, 0.99, 1.0, 7.0}) {
    std::vector<bool> counted(found.size());
    for (std::size_t i = 0; i < list.count_within(distance); ++i) counted[list.id(i)] = true;
    for (const NearbyTriangle& one : found) {
      if (one.nearest > distance) continue;
      EXPECT_TRUE(counted[one.id]) << one.id;
    }
  }
  EXPECT_LT(list.count_within(0.25), found.size() / 2);
  EXPECT_EQ(list.count_within(1), found.size());
}

// A grid of triangles, whose corners share coordinates.
TEST(NearbyTriangles, FindsTrianglesByCorner) {
  for (const unsigned count : {1u, 15u, 16u, 63u, 64u, 65u, 130u, 192u}) {
    std::vector<NearbyTriangle> found;
    for (unsigned i = 0; i < count; ++i) {
      Triangle at = triangle_at(i % 24 / 4.0);
      for (Point& corner : at) corner.y() += static_cast<double>(i) * 0.125;
      at[2].x() += 2;
      found.push_back({at, i, 0});
    }
    const auto list = listed(found, Point(0.3, 0, 0));
    for (const NearbyTriangle& one : found)
      for (const Point& corner : one.corners) {
        NearbyTriangleBits expected{};
        for (std::size_t i = 0; i < count; ++i)
          for (const Point& other : list.triangle(i))
            if (other.x() == corner.x()) expected[i / 64] |= std::uint64_t{1} << i % 64;
        for (const NearbyTriangleBits& bits :
             on_each_target([&] { return triangles_with_corner(list, corner); }))
          ASSERT_EQ(bits, expected) << count;
      }
  }
}

TEST(NearbyTriangles, HandlesTrianglesAtTheBallsRadius) {
  NearbyTriangles list;
  list.fill(std::vector<NearbyTriangle>{found_at(1, 5, 1)}, Point::Zero(), 1, 1);
  EXPECT_EQ(list.count_within(1), 1u);
}

TEST(NearbyTriangles, IsCompleteOnlyWhenFilled) {
  NearbyTriangles list;
  EXPECT_FALSE(list.complete());
  list.fill({}, Point::Zero(), 0, 1);
  EXPECT_FALSE(list.complete());
  list.fill(std::vector<NearbyTriangle>{found_at(1, 0)}, Point::Zero(), 0, 1);
  EXPECT_TRUE(list.complete());
  list.clear();
  EXPECT_FALSE(list.complete());
}

TEST(NearbyTriangles, RefusesExtentsTooSmallForFloat) {
  const Point corner(1 + 0x1p-50, 0, 0);
  EXPECT_FALSE(listed({{{corner, corner, corner}, 0, 0}}, Point(1, 0, 0)).complete());
}

}  // namespace
}  // namespace planetree::octree
