#include "octree/nearest/height_field.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace planetree::octree {
namespace {

const Triangle kUpright{Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)};
const Point kUp(0, 0, 1);

void add(FacingSides& sides, const Triangle& face, const Point& normal) {
  sides.add(face, normal, (face[1] - face[0]).cross(face[2] - face[0]).squaredNorm());
}

TEST(FacingSides, IsTheCommonSideOfAllFaces) {
  const Point above(0.2, 0.2, 0.1), below(0.2, 0.2, -0.1);
  for (const auto& [query, side] : {std::pair(above, 1), std::pair(below, -1)}) {
    FacingSides sides(query);
    add(sides, kUpright, kUp);
    EXPECT_EQ(sides.common(), side);
    add(sides, {Point(0, 0, 0), Point(0, 1, 0), Point(-1, 0, 0)}, kUp);
    EXPECT_EQ(sides.common(), side);
    // An upright face between the query and the others.
    add(sides, {Point(0, 0, 0), Point(0, 1, 0), Point(0, 0, 1)}, Point(side, 0, 0));
    EXPECT_EQ(sides.common(), side);
    add(sides, {Point(0, 0, 0), Point(0, 0, 1), Point(0, 1, 0)}, Point(-side, 0, 0));
    EXPECT_EQ(sides.common(), 0);
  }
}

TEST(FacingSides, IsUnknownWithinRounding) {
  for (const double height : {0x1p-19, -0x1p-19, 0x1p-22, -0x1p-22, 0.0}) {
    const Point query(0.5, 0.25, height);
    FacingSides sides(query);
    add(sides, kUpright, kUp);
    EXPECT_EQ(sides.common(), height > 0x1p-20 ? 1 : height < -0x1p-20 ? -1 : 0) << height;
  }
  const Point query(0, 0, 1);
  FacingSides unknown(query);
  add(unknown, kUpright, kUp);
  unknown.add_unknown();
  EXPECT_EQ(unknown.common(), 0);
}

TEST(FacingSides, IsUnknownForSmallFacesAndNearEnds) {
  const Point query(0, 0, 1);
  for (const double size : {1.0, 0x1p-12, 0x1p-15, 0x1p-17, 0x1p-30}) {
    FacingSides sides(query);
    add(sides, {Point(0, 0, 0), Point(size, 0, 0), Point(0, size, 0)}, kUp);
    EXPECT_EQ(sides.common(), size * size >= 0x1p-32 ? 1 : 0) << size;
  }
  for (const double distance : {1.0, 0x1p-32, 0x1p-33, 0.0}) {
    FacingSides sides(query);
    add(sides, kUpright, kUp);
    sides.end_after(distance);
    EXPECT_EQ(sides.common(), distance >= 0x1p-32 ? 1 : 0) << distance;
  }
}

TEST(HeightField, DecidesTheSideOfExactAnswersOnly) {
  NearestAnswer nearest;
  nearest.is_height_field = true;
  nearest.status = Status::kExact;
  nearest.lower = 1;
  nearest.upper = 1 + 0x1p-45;
  EXPECT_TRUE(HeightField::tells_side(nearest));
  nearest.upper = 1 + 0x1p-43;
  EXPECT_FALSE(HeightField::tells_side(nearest));
  nearest.upper = 1;
  nearest.is_height_field = false;
  EXPECT_FALSE(HeightField::tells_side(nearest));
  nearest.is_height_field = true;
  for (const Status status : {Status::kWithinError, Status::kDegraded}) {
    nearest.status = status;
    EXPECT_FALSE(HeightField::tells_side(nearest));
  }
}

}  // namespace
}  // namespace planetree::octree
