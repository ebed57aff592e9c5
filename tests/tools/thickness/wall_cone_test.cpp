#include "tools/thickness/wall_cone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace planetree::tools {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(WallCone, ReachesPointsOfASphereAtItsRadius) {
  const WallCone cone({0, 0, 1}, {0, 0, -1}, 0.5, 1);
  for (double angle = 0.1; angle < 6.3; angle += 0.1) {
    const Vec3 point{std::sin(angle), 0, std::cos(angle)};
    const double rise = std::sin(std::fabs(std::remainder(angle, 2 * M_PI)) / 2);
    if (rise > 0.501) {
      EXPECT_NEAR(cone.radius_to(point), 1, 1e-12) << angle;
    } else if (rise < 0.499) {
      EXPECT_EQ(cone.radius_to(point), kInfinity) << angle;
    }
  }
  EXPECT_EQ(cone.radius_to({0, 0, 1}), kInfinity) << "the apex itself";
  EXPECT_EQ(cone.radius_to({0, 0, 2}), kInfinity) << "on the other side";
}

// The bound of a plane is that of the point of it in the cone that is reached first.
TEST(WallCone, BoundsAllPointsOfAPlane) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  int reached = 0;
  for (int i = 0; i < 60; ++i) {
    const WallCone cone({0, 0, 0}, {0, 0, 1}, 0.5, 1);
    Vec3 normal{any(random), any(random), any(random)};
    const double length = std::hypot(normal.x, normal.y, normal.z);
    normal = {normal.x / length, normal.y / length, normal.z / length};
    const double height = any(random);
    const Vec3 point{height * normal.x, height * normal.y, height * normal.z};
    const double bound = cone.least_radius_to_plane(point, normal);
    double least = kInfinity;
    // Along each direction of the cone.
    for (int a = 0; a <= 120; ++a)
      for (int b = 0; b < 360; ++b) {
        const double elevation = M_PI / 6 + a * M_PI / 3 / 120, azimuth = b * M_PI / 180;
        const Vec3 way{std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
        const double towards = way.x * normal.x + way.y * normal.y + way.z * normal.z;
        const double distance = height / towards;
        if (distance > 0) least = std::min(least, distance / (2 * way.z));
      }
    if (least == kInfinity) continue;
    ++reached;
    EXPECT_LE(bound, least * (1 + 1e-9));
    EXPECT_GE(bound, 0.99 * std::min(least, 20.0)) << "as near as the directions are dense";
  }
  EXPECT_GT(reached, 30);
}

TEST(WallCone, LeavesOutPlanesThroughTheApexThatLeanLittle) {
  const WallCone cone({1, 2, 3}, {0, 0, 1}, 0.5, 10);
  const auto leaning = [](double degrees) {
    return Vec3{std::sin(degrees * M_PI / 180), 0, std::cos(degrees * M_PI / 180)};
  };
  for (const double sign : {1.0, -1.0}) {
    const Vec3 little = leaning(29), much = leaning(31);
    EXPECT_EQ(
        cone.least_radius_to_plane({1, 2, 3 + sign * 1e-11}, {sign * little.x, 0, sign * little.z}),
        kInfinity);
    EXPECT_EQ(cone.least_radius_to_plane({1, 2, 3}, {sign * much.x, 0, sign * much.z}), 0);
  }
}

// What a ball hides: the surface of a smaller ball that touches at the apex is within it.
TEST(WallCone, BoundsWhatIsHiddenByADepth) {
  const WallCone cone({0, 0, 0}, {0, 0, 1}, 0.5, 1);
  for (double smaller = 0.01; smaller < 1; smaller += 0.01)
    for (double elevation = M_PI / 6; elevation <= M_PI / 2; elevation += 0.02) {
      const double length = 2 * smaller * std::sin(elevation);
      const Vec3 point{length * std::cos(elevation), 0, length * std::sin(elevation)};
      const double depth = 1 - std::hypot(point.x, point.z - 1);
      const double hidden = cone.hidden(depth) * (1 + 1e-12);
      EXPECT_TRUE(smaller <= hidden || smaller >= 1 - hidden) << smaller << ' ' << elevation;
    }
}

}  // namespace
}  // namespace planetree::tools
