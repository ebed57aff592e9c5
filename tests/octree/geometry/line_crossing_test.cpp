#include "octree/geometry/line_crossing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace planetree::octree {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();
const LineRange kRay{0, kEndless}, kSegment{0, 1};
const Triangle kFlat{Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)};

Line ray(const Point& origin, const Point& direction) { return {origin, direction, Point::Zero()}; }
Line segment(const Point& from, const Point& to) { return {from, to, from}; }

TEST(LineCrossing, TellsEnteringFromLeaving) {
  const LineCrossing in = cross(ray({0.25, 0.25, 2}, {0, 0, -1}), kRay, kFlat);
  EXPECT_EQ(in.sign, 1);
  EXPECT_EQ(in.t, 2);
  EXPECT_EQ(cross(ray({0.25, 0.25, -2}, {0, 0, 4}), kRay, kFlat).sign, -1);
  EXPECT_EQ(cross(ray({0.25, 0.25, -2}, {0, 0, 4}), kRay, kFlat).t, 0.5);
  EXPECT_EQ(cross(ray({0.25, 0.25, 2}, {0, 0, 1}), kRay, kFlat).sign, 0);
  EXPECT_EQ(cross(ray({0.75, 0.75, 2}, {0, 0, -1}), kRay, kFlat).sign, 0);
}

// Both triangles of a square, seen along its diagonal and its corners.
TEST(LineCrossing, MeetsOneTriangleOfThoseAtAnEdge) {
  const Triangle other{Point(1, 0, 0), Point(1, 1, 0), Point(0, 1, 0)};
  for (const Point& at : {Point(0.5, 0.5, 1), Point(0.25, 0.75, 1), Point(0.1, 0.9, 1)}) {
    const Line down = ray(at, {0, 0, -1});
    EXPECT_EQ(cross(down, kRay, kFlat).sign + cross(down, kRay, other).sign, 1);
  }
}

TEST(LineCrossing, DoesNotMeetWhatItRunsWithin) {
  EXPECT_EQ(cross(ray({-1, 0.25, 0}, {1, 0, 0}), kRay, kFlat).sign, 0);
  EXPECT_EQ(cross(ray({0.1, 0.1, 0}, {1, 1, 0}), kRay, kFlat).sign, 0);
  const Triangle needle{Point(0, 0, 0), Point(1, 0, 0), Point(2, 0, 0)};
  EXPECT_EQ(cross(ray({0.5, 0, 1}, {0, 0, -1}), kRay, needle).sign, 0);
}

// The ends of a segment are exact, however little they are beside the plane.
TEST(LineCrossing, TellsTheEndsOfASegmentExactly) {
  const double least = std::numeric_limits<double>::denorm_min();
  const auto meets = [](double from, double to) {
    return cross(segment({0.25, 0.25, from}, {0.25, 0.25, to}), kSegment, kFlat).sign != 0;
  };
  EXPECT_TRUE(meets(1, 0));
  EXPECT_TRUE(meets(0, 1));
  EXPECT_TRUE(meets(least, -1));
  EXPECT_TRUE(meets(1, -least));
  EXPECT_FALSE(meets(1, least));
  EXPECT_FALSE(meets(least, 1));
  EXPECT_FALSE(meets(-least, -0x1p60));
  EXPECT_FALSE(meets(0x1p-60, 0x1p-61));
  EXPECT_TRUE(meets(-0x1p60, least));
}

TEST(LineCrossing, TellsTheSignOfPositionsThatUnderflow) {
  const double least = std::numeric_limits<double>::denorm_min();
  for (const double length : {1.0, 0x1p100, 0x1p300}) {
    const LineCrossing before = cross(ray({0.25, 0.25, -least}, {0, 0, length}), kRay, kFlat);
    EXPECT_EQ(before.sign, -1);
    EXPECT_GT(before.t, 0);
    EXPECT_LE(before.t - before.error, least / length);
    EXPECT_EQ(cross(ray({0.25, 0.25, least}, {0, 0, length}), kRay, kFlat).sign, 0);
  }
}

TEST(LineCrossing, HasTheSameBitsForAnyOrderOfTheCorners) {
  const Triangle tilted{Point(0, 0, 0.1), Point(1, 0.3, 0.77), Point(0.2, 1, 0.31)};
  const Line line = ray({0.3, 0.2, 5}, {0.01, 0.02, -0.7});
  const LineCrossing found = cross(line, kRay, tilted);
  ASSERT_NE(found.sign, 0);
  const auto& [a, b, c] = tilted;
  for (const Triangle& turned : {Triangle{b, c, a}, Triangle{c, a, b}})
    EXPECT_EQ(cross(line, kRay, turned).t, found.t);
  for (const Triangle& mirrored : {Triangle{b, a, c}, Triangle{a, c, b}, Triangle{c, b, a}}) {
    EXPECT_EQ(cross(line, kRay, mirrored).t, found.t);
    EXPECT_EQ(cross(line, kRay, mirrored).sign, -found.sign);
  }
}

// Nearly parallel to the plane, far away, and with coordinates of all sizes.
TEST(LineCrossing, KeepsItsPrecisionWhereDoubleLosesIt) {
  const LineCrossing flat = cross(ray({-0x1p40, 0.25, 0x1p-60}, {1, 0, -0x1p-100}), kRay, kFlat);
  EXPECT_EQ(flat.sign, 1);  // through an edge
  EXPECT_EQ(flat.t, 0x1p40);
  const LineCrossing grazing = cross(ray({-1, 0.25, 0x1p-60}, {1, 0, -0.8 * 0x1p-60}), kRay, kFlat);
  EXPECT_EQ(grazing.sign, 1);
  EXPECT_NEAR(grazing.t, 1.25, 1e-15);
  EXPECT_LT(grazing.error, 1e-14);
  const LineCrossing far = cross(ray({0.25, 0.25, 0x1p300}, {0, 0, -1}), kRay, kFlat);
  EXPECT_EQ(far.sign, 1);
  EXPECT_EQ(far.t, 0x1p300);
}

TEST(LineCrossing, OfALineWithoutDirectionIsThatOfItsOrigin) {
  EXPECT_NE(cross(segment({0.25, 0.25, 0}, {0.25, 0.25, 0}), kSegment, kFlat).sign, 0);
  EXPECT_EQ(cross(segment({0.25, 0.25, 1}, {0.25, 0.25, 1}), kSegment, kFlat).sign, 0);
}

}  // namespace
}  // namespace planetree::octree
