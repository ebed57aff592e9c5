#include "octree/geometry/cell_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace planetree::octree {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

Region some_region() { return {{-1, 0.25, 0.5}, {0.5, 3, 0.75}, {0, 0, 0}, {1, 1, 1}}; }

TEST(Region, HasWallsWhereSidesAreWithinTheModelBox) {
  const Region region = some_region();
  EXPECT_EQ(region.lower(), Point(-kFar, 0.25, 0.5));
  EXPECT_EQ(region.upper(), Point(0.5, kFar, 0.75));
  EXPECT_TRUE(region.has_walls());
  EXPECT_FALSE(Region().has_walls());
  EXPECT_FALSE(Region({0, 0, 0}, {1, 1, 1}, {0, 0, 0}, {1, 1, 1}).has_walls());
  EXPECT_TRUE(
      Region({0, 0, 0}, {1, 1, std::nextafter(1.0, 0.0)}, {0, 0, 0}, {1, 1, 1}).has_walls());
}

TEST(Region, ContainsItsWalls) {
  const Region region = some_region();
  EXPECT_TRUE(region.holds({0.5, 0.25, 0.5}));
  EXPECT_TRUE(region.holds({-1e300, kFar, 0.6}));
  EXPECT_FALSE(region.holds({std::nextafter(0.5, 1.0), 0.25, 0.5}));
  EXPECT_FALSE(region.holds({0, 0.3, std::nextafter(0.5, 0.0)}));
  EXPECT_TRUE(Region().holds({kFar, -kFar, 0}));
  EXPECT_EQ(region.clamped({0.7, 0.1, 0.6}), Point(0.5, 0.25, 0.6));
  EXPECT_TRUE(region.meets({0.5, 0.1, 0.1}, {0.9, 0.25, 0.5}));
  EXPECT_FALSE(region.meets({0.51, 0.1, 0.1}, {0.9, 0.25, 0.5}));
}

// The clearance is slightly less than the distance to the nearest wall, to cover all rounding.
TEST(Region, ClearanceEndsBeforeTheNearestWall) {
  const Region region = some_region();
  const double clear = region.clearance({0.25, 10, 0.625}, kMaxDiagonal);
  EXPECT_LT(clear, 0.125 - 0x1p-39);
  EXPECT_GT(clear, 0.125 - 0x1p-36);
  EXPECT_LT(region.clearance({-1e200, 10, 0.5}, kMaxDiagonal), 0);
  EXPECT_LT(region.clearance({0, 0, 0}, kMaxDiagonal), 0);
  EXPECT_EQ(Region().clearance({1e200, 0, 0}, kMaxDiagonal), kFar);
}

TEST(ClippedGrid, EndsCellsAtTheWalls) {
  const ClippedGrid grid({0, 0, 0}, some_region());
  const GridCell root;
  EXPECT_EQ(grid.lower(root), Point(0, 0.25, 0.5));
  EXPECT_EQ(grid.upper(root), Point(0.5, 2, 0.75));
  EXPECT_EQ(grid.middle(root), Point(0.5, 1, 0.75));
  // The child begins at 1 along x, beyond the wall at 0.5: it is flat, at the wall.
  EXPECT_EQ(grid.lower(root.child(1)), Point(0.5, 0.25, 0.5));
  EXPECT_EQ(grid.upper(root.child(1)), Point(0.5, 1, 0.75));
  EXPECT_TRUE(grid.has_part_of(root.child(0)));
  EXPECT_TRUE(grid.has_part_of(root.child(2)));
  EXPECT_FALSE(grid.has_part_of(root.child(1)));
  EXPECT_FALSE(grid.has_part_of(root.child(4)));
}

TEST(ClippedGrid, HasAPartOfCellsThatTouchAWall) {
  const ClippedGrid grid({0, 0, 0}, {{1, 0, 0}, {1, 1, 1}, {0, 0, 0}, {1.5, 1, 1}});
  EXPECT_TRUE(grid.has_part_of(GridCell{}.child(0)));
  EXPECT_TRUE(grid.has_part_of(GridCell{}.child(1)));
  EXPECT_FALSE(grid.has_part_of(GridCell{2, {0, 0, 0}}));
  EXPECT_EQ(grid.upper(GridCell{}.child(0)).x(), 1);
  EXPECT_EQ(grid.upper(GridCell{}.child(1)).x(), 1);
}

}  // namespace
}  // namespace planetree::octree
