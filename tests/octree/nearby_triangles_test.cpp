#include "octree/nearby_triangles.h"

#include <gtest/gtest.h>

namespace planetree::octree {
namespace {

Triangle triangle_at(double x) { return {Point(x, 0, 0), Point(x + 1, 0, 0), Point(x, 1, 0)}; }

TEST(NearbyTriangles, KeepsCornersExactly) {
  NearbyTriangles list;
  list.begin(Point(0.1, 0.2, 0.3));
  const Triangle corners = triangle_at(1.0 / 3);
  ASSERT_TRUE(list.add(corners, 7));
  list.finish();
  EXPECT_TRUE(list.complete());
  EXPECT_EQ(list.size(), 1u);
  EXPECT_EQ(list.triangle(0), corners);
  EXPECT_EQ(list.id(0), 7u);
}

TEST(NearbyTriangles, HasRoomForSoManyAndNoMore) {
  NearbyTriangles list;
  list.begin(Point::Zero());
  for (std::size_t i = 0; i < NearbyTriangles::kMost; ++i)
    EXPECT_TRUE(list.add(triangle_at(static_cast<double>(i)), i));
  EXPECT_FALSE(list.add(triangle_at(0), 99));
  EXPECT_EQ(list.size(), NearbyTriangles::kMost);
}

TEST(NearbyTriangles, ReachesAsFarAsItsFarthestCorner) {
  NearbyTriangles list;
  list.begin(Point(0, 0, 4));
  ASSERT_TRUE(list.add(triangle_at(2), 0));
  list.finish();
  EXPECT_GE(list.extent(), 5);
  EXPECT_LE(list.extent(), 5.0001);
}

TEST(NearbyTriangles, RepeatsTheLastUpToAWholeVector) {
  NearbyTriangles list;
  list.begin(Point(0.5, 0, 0));
  ASSERT_TRUE(list.add(triangle_at(1), 0));
  ASSERT_TRUE(list.add(triangle_at(2), 1));
  list.finish();
  EXPECT_EQ(list.row(0, 0)[0], 0.5f);
  EXPECT_EQ(list.row(1, 0)[1], 2.5f);
  for (std::size_t i = 2; i < 8; ++i) EXPECT_EQ(list.row(0, 0)[i], list.row(0, 0)[1]) << i;
}

TEST(NearbyTriangles, IsNoListBeforeItIsFinishedNorOfNothing) {
  NearbyTriangles list;
  list.begin(Point::Zero());
  EXPECT_FALSE(list.complete());
  list.finish();
  EXPECT_FALSE(list.complete());
  ASSERT_TRUE(list.add(triangle_at(1), 0));
  EXPECT_FALSE(list.complete());
  list.finish();
  EXPECT_TRUE(list.complete());
  list.begin(Point::Zero());
  EXPECT_FALSE(list.complete());
}

TEST(NearbyTriangles, RefusesWhatIsTooSmallForFloat) {
  NearbyTriangles list;
  list.begin(Point(1, 0, 0));
  const Point corner(1 + 0x1p-50, 0, 0);
  ASSERT_TRUE(list.add({corner, corner, corner}, 0));
  list.finish();
  EXPECT_FALSE(list.complete());
}

}  // namespace
}  // namespace planetree::octree
