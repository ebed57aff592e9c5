#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/oracle/built_model.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/random.h"
#include "tools/thickness/thickness_search.h"

namespace planetree::tools {
namespace {

using oracle::BuiltModel;
using oracle::Corners;
using oracle::Soup;
using oracle::operator+;
using oracle::operator-;
using oracle::operator*;

/// A closed surface: a sphere of radius 1 whose corners are moved along their radii by up to a
/// share.
Soup crumpled_sphere(int rings, double share, oracle::Random& random) {
  const int sides = 2 * rings;
  std::vector<Vec3> corners;
  for (int ring = 0; ring <= rings; ++ring)
    for (int side = 0; side < sides; ++side) {
      const auto [height, radius] = oracle::on_circle(0.5 * ring / rings);
      const auto [x, y] = oracle::on_circle(static_cast<double>(side) / sides);
      const double factor = 1 + share * random.either_sign();
      const bool is_pole = ring == 0 || ring == rings;
      corners.push_back(is_pole ? Vec3{0, 0, ring == 0 ? 1.0 : -1.0}
                                : Vec3{radius * x, radius * y, height} * factor);
    }
  Soup soup;
  const auto at = [&](int ring, int side) {
    return corners[static_cast<std::size_t>(ring * sides + side % sides)];
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int side = 0; side < sides; ++side) {
      if (ring + 1 < rings)
        soup.push_back({at(ring, side), at(ring + 1, side), at(ring + 1, side + 1)});
      if (ring > 0) soup.push_back({at(ring, side), at(ring + 1, side + 1), at(ring, side + 1)});
    }
  return soup;
}

/// Points all over the triangles, with their corners.
std::vector<Vec3> points_of(const Soup& soup) {
  constexpr int kSteps = 12;
  std::vector<Vec3> points;
  for (const auto& [a, b, c] : soup)
    for (int i = 0; i <= kSteps; ++i)
      for (int j = 0; i + j <= kSteps; ++j)
        points.push_back(a + (b - a) * (1.0 * i / kSteps) + (c - a) * (1.0 * j / kSteps));
  return points;
}

double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// The thickness by the definition, for some points of the surface: the least diameter of a ball
/// that touches the plane at `apex` and reaches one of them. The apex itself is left out.
double sampled_thickness(const Vec3& apex, const Vec3& axis, const std::vector<Vec3>& surface) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& point : surface) {
    const Vec3 way = point - apex;
    const double rise = dot(way, axis), square = dot(way, way);
    if (square > 1e-16 && rise > 0 && rise * rise >= 0.25 * square)
      least = std::min(least, square / rise);
  }
  return least;
}

TEST(Thickness, HoldsTheDefinitionOnCrumpledSurfaces) {
  int narrow = 0, all = 0;
  for (const double share : {0.0, 0.01, 0.1, 0.3}) {
    oracle::Random random(static_cast<std::uint64_t>(100 * share) + 1);
    BuiltModel model(crumpled_sphere(8, share, random));
    ThicknessOptions options;
    options.max_thickness = 4;
    ThicknessSearch search(model.probe(), options);
    std::vector<Vec3> middles, normals;
    for (const auto& [a, b, c] : model.triangles()) {
      middles.push_back((a + b + c) * (1.0 / 3));
      const Vec3 p = b - a, q = c - a;
      const Vec3 cross{p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
      normals.push_back(cross * (1 / std::sqrt(dot(cross, cross))));
    }
    std::vector<WallThickness> walls(middles.size());
    search.measure(middles, walls);
    const std::vector<Vec3> surface = points_of(model.triangles());
    for (std::size_t i = 0; i < middles.size(); ++i) {
      const WallThickness& wall = walls[i];
      ASSERT_TRUE(wall.has_contact);
      const double sampled = sampled_thickness(middles[i], normals[i] * -1, surface);
      EXPECT_LE(wall.lower, sampled * (1 + 1e-9)) << share << ' ' << i;
      EXPECT_LE(wall.lower, wall.thickness);
      EXPECT_LE(wall.thickness, wall.upper);
      // The contact is on the surface, in the cone, and gives the upper end.
      EXPECT_LT(model.closest_point(wall.contact).distance, 1e-12);
      EXPECT_NEAR(sampled_thickness(middles[i], normals[i] * -1, {wall.contact}), wall.thickness,
                  1e-8);
      ++all;
      narrow += wall.upper - wall.lower < 0.1 * wall.upper ? 1 : 0;
    }
  }
  EXPECT_GT(narrow, 0.6 * all);
}

}  // namespace
}  // namespace planetree::tools
