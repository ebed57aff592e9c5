#include "octree/geometry/angles.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "octree/geometry/work_limit.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

const Triangle kFace{Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)};  // back towards negative z

Triangle scaled(const Triangle& triangle, double factor, const Point& offset = Point::Zero()) {
  Triangle result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = triangle[k] * factor + offset;
  return result;
}

// Six pyramids, one for each face of a cube, from its middle; each is two triangles.
TEST(WindingShare, HalfACubeFaceIsATwelfth) {
  const Triangle half{Point(-1, -1, 1), Point(1, -1, 1), Point(1, 1, 1)};
  const WindingShare share = winding_share(Point::Zero(), half);
  EXPECT_NEAR(share.value, 1.0 / 12, share.error);
  EXPECT_LT(share.error, 0x1p-44);
  EXPECT_GT(share.error, 0);
}

TEST(WindingShare, IsPositiveFromBehind) {
  EXPECT_GT(winding_share({0.2, 0.2, -1}, kFace).value, 0);
  EXPECT_LT(winding_share({0.2, 0.2, 1}, kFace).value, 0);
  EXPECT_EQ(winding_share({0.2, 0.2, 1}, kFace).value, -winding_share({0.2, 0.2, -1}, kFace).value);
}

TEST(WindingShare, ApproachesOneHalfAtTheFace) {
  for (int exponent = -10; exponent >= -1074; exponent -= 7) {
    const double height = std::ldexp(1.0, exponent);
    for (const double side : {1.0, -1.0}) {
      const WindingShare share = winding_share({0.25, 0.25, side * height}, kFace);
      EXPECT_FALSE(share.on_surface);
      EXPECT_NEAR(share.value, -side * 0.5, 4 * height + share.error);
      EXPECT_LT(share.error, 0x1p-40);
    }
  }
}

TEST(WindingShare, ChargesWideNumbers) {
  std::uint64_t units = 0;
  WorkLimit limit(units, WorkLimit::kNone);
  winding_share({0.5, -0.25, -0.25}, kFace, &limit);
  EXPECT_EQ(units, 0u);
  winding_share({0.5, -0x1p-30, -0x1p-30}, kFace, &limit);
  EXPECT_EQ(units, 64u);
}

// The quotient is 0 / 0 there.
TEST(WindingShare, IsZeroOnTheTriangle) {
  const Point on[] = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}, {0.25, 0.25, 0}, {0.5, 0.5, 0}};
  for (const Point& point : on) {
    const WindingShare share = winding_share(point, kFace);
    EXPECT_TRUE(share.on_surface);
    EXPECT_EQ(share.value, 0);
    EXPECT_EQ(share.error, 0);
  }
}

TEST(WindingShare, IsZeroInThePlaneOutsideTheTriangle) {
  const double ulp = std::numeric_limits<double>::denorm_min();
  for (const Point& point :
       {Point(2, 0, 0), Point(-1, 0, 0), Point(0.5, -ulp, 0), Point(1, 1, 0)}) {
    const WindingShare share = winding_share(point, kFace);
    EXPECT_FALSE(share.on_surface);
    EXPECT_EQ(share.value, 0);
    EXPECT_EQ(share.error, 0);
  }
}

// The share is half the angle between the planes through the edge: a quarter of a turn, less what
// the far corner cuts off.
TEST(WindingShare, IsAccurateNearAnEdge) {
  const double half_turn = winding_share({0.5, -0x1p-40, -0x1p-40}, kFace).value;
  for (const int exponent : {-50, -100, -300, -1000, -1074}) {
    const double step = std::ldexp(1.0, exponent);
    const WindingShare share = winding_share({0.5, -step, -step}, kFace);
    EXPECT_NEAR(share.value, half_turn, 0x1p-36) << exponent;
    EXPECT_NEAR(share.value, 0.125, 0x1p-36) << exponent;
    EXPECT_LT(share.error, 0x1p-24) << exponent;
  }
}

TEST(WindingShare, IsAccurateNearACorner) {
  const WindingShare near = winding_share({-0x1p-30, -0x1p-31, -0x1p-30}, kFace);
  for (const int exponent : {-100, -500, -1000, -1070}) {
    const double step = std::ldexp(1.0, exponent);
    const WindingShare share = winding_share({-2 * step, -step, -2 * step}, kFace);
    EXPECT_NEAR(share.value, near.value, 0x1p-28) << exponent;
    EXPECT_LT(share.error, 0x1p-24) << exponent;
  }
}

TEST(WindingShare, IsIndependentOfScale) {
  const Point point(0.3, 0.4, -0.2);
  const WindingShare unit = winding_share(point, kFace);
  for (const int exponent : {-1070, -900, -400, -200, 100, 200, 300}) {
    const double size = std::ldexp(1.0, exponent);
    // Coordinates with few bits stay exact where they are subnormal.
    const WindingShare share = winding_share(size * Point(0.25, 0.5, -0.25), scaled(kFace, size));
    EXPECT_NEAR(share.value, winding_share({0.25, 0.5, -0.25}, kFace).value, 0x1p-40) << exponent;
    EXPECT_LT(share.error, 0x1p-24);
  }
  EXPECT_LT(unit.error, 0x1p-44);
}

TEST(WindingShare, IsZeroWithoutArea) {
  const Triangle segment{Point(0, 0, 0), Point(1, 1, 1), Point(3, 3, 3)};
  const Triangle point{Point(1, 2, 3), Point(1, 2, 3), Point(1, 2, 3)};
  for (const Triangle& flat : {segment, point}) {
    EXPECT_EQ(winding_share({0.1, 0.7, 0.2}, flat).value, 0);
    EXPECT_TRUE(winding_share(flat[0], flat).on_surface);
  }
}

// The shares of a closed surface sum to a whole number at any point.
TEST(WindingShare, SumsToAWholeNumberOverClosedSurfaces) {
  Noise noise(5);
  int off_surface = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3 corners[] = {noise.point(-1, 1), noise.point(-1, 1), noise.point(-1, 1),
                            noise.point(-1, 1)};
    Point p[4];
    for (int k = 0; k < 4; ++k) p[k] = Point(corners[k].x, corners[k].y, corners[k].z);
    const double near = std::ldexp(1.0, -static_cast<int>(noise.bits() % 60));
    const Vec3 by = noise.point(-near, near);
    // A point near the middle of an edge.
    const Point point = (p[0] + p[1]) / 2 + Point(by.x, by.y, by.z);
    double sum = 0, error = 0;
    for (const Triangle& face : {Triangle{p[0], p[1], p[2]}, Triangle{p[0], p[2], p[3]},
                                 Triangle{p[0], p[3], p[1]}, Triangle{p[1], p[3], p[2]}}) {
      const WindingShare share = winding_share(point, face);
      if (share.on_surface) sum = std::numeric_limits<double>::quiet_NaN();
      sum += share.value;
      error += share.error + 0x1p-50;
    }
    if (std::isnan(sum)) continue;
    ++off_surface;
    EXPECT_NEAR(sum, std::round(sum), error);
    EXPECT_LT(error, 0x1p-20);
  }
  EXPECT_GT(off_surface, 300);
}

}  // namespace
}  // namespace planetree::octree
