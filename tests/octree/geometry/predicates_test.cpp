#include "octree/geometry/predicates.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cfenv>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "tests/octree/support/odd_arithmetic.h"

namespace planetree::octree {
namespace {

using Rational = boost::multiprecision::cpp_rational;

int rational_orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
  Rational u[3], v[3], w[3];
  for (int i = 0; i < 3; ++i) {
    u[i] = Rational(b[i]) - Rational(a[i]);
    v[i] = Rational(c[i]) - Rational(a[i]);
    w[i] = Rational(d[i]) - Rational(a[i]);
  }
  const Rational volume = u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
                          u[2] * (v[0] * w[1] - v[1] * w[0]);
  return volume.sign();
}

int rational_normal_sign(const Point& a, const Point& b, const Point& c, unsigned axis) {
  const unsigned i = (axis + 1) % 3, j = (axis + 2) % 3;
  const Rational area = (Rational(b[i]) - Rational(a[i])) * (Rational(c[j]) - Rational(a[j])) -
                        (Rational(b[j]) - Rational(a[j])) * (Rational(c[i]) - Rational(a[i]));
  return area.sign();
}

// Points within two ulps of the plane x + y + z = 1.
Point on_ulp_grid(std::mt19937_64& random) {
  std::uniform_int_distribution<int> step(-2, 2);
  const Point bases[] = {{0.5, 0.25, 0.25}, {0.75, 0.125, 0.125}, {0.25, 0.5, 0.25}, {1, 0, 0}};
  Point point = bases[random() % 4];
  for (double& value : point) value += step(random) * 0x1p-53;
  return point;
}

TEST(Predicates, OrientationIsExactOnAnUlpGrid) {
  std::mt19937_64 random(38);
  int flat = 0;
  for (int i = 0; i < 4000; ++i) {
    const Point a = on_ulp_grid(random), b = on_ulp_grid(random), c = on_ulp_grid(random),
                d = on_ulp_grid(random);
    const int expected = rational_orientation(a, b, c, d);
    ASSERT_EQ(orientation(a, b, c, d), expected);
    flat += expected == 0;
  }
  EXPECT_GT(flat, 20);
}

TEST(Predicates, PolygonAreaIsExactOnAnUlpGrid) {
  std::mt19937_64 random(44);
  int zero = 0;
  for (int i = 0; i < 2000; ++i) {
    std::vector<Vec3> corners;
    for (std::size_t k = 0, count = 3 + random() % 5; k < count; ++k) {
      const Point p = on_ulp_grid(random);
      corners.push_back({p.x(), p.y(), p.z()});
    }
    for (unsigned axis = 0; axis < 3; ++axis) {
      Rational sum = 0;
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3 &p = corners[k], &q = corners[(k + 1) % corners.size()];
        const double from[] = {p.x, p.y, p.z}, to[] = {q.x, q.y, q.z};
        const unsigned u = (axis + 1) % 3, v = (axis + 2) % 3;
        sum += Rational(from[u]) * Rational(to[v]) - Rational(from[v]) * Rational(to[u]);
      }
      ASSERT_EQ(polygon_area_sign(corners, axis), sum.sign());
      ASSERT_EQ(exact_polygon_area_sign(corners, axis), sum.sign());
      zero += sum == 0;
    }
  }
  EXPECT_GT(zero, 20);
}

TEST(Predicates, OrientationIsExactNearTheSmallestNumbers) {
  std::mt19937_64 random(43);
  std::uniform_int_distribution<int> exponent(-1074, -300), mantissa(-3, 3);
  const auto tiny = [&] {
    const int digit = mantissa(random);
    return std::ldexp(digit, exponent(random));
  };
  for (int i = 0; i < 1000; ++i) {
    Point points[4];
    for (Point& point : points) point = {tiny(), tiny(), i % 2 == 0 ? tiny() : 1.0};
    ASSERT_EQ(orientation(points[0], points[1], points[2], points[3]),
              rational_orientation(points[0], points[1], points[2], points[3]));
  }
}

// Whole numbers of some bits along each axis, in units that differ by axis: all sizes that integers
// of 128 bits can hold, and some that they cannot. Every second set of points is flat.
TEST(Predicates, SignsAreExactForCoordinatesOfEverySize) {
  std::mt19937_64 random(47);
  int flat = 0, wide = 0;
  for (int i = 0; i < 6000; ++i) {
    int bits[3], unit[3], sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      bits[axis] = static_cast<int>(random() % 53) + 1;
      unit[axis] = static_cast<int>(random() % 200) - 100;
      sum += bits[axis];
    }
    wide += sum > 120;
    Point p[4];
    for (Point& point : p)
      for (int axis = 0; axis < 3; ++axis) {
        const auto whole = static_cast<std::int64_t>(random() >> (64 - bits[axis]));
        point[axis] =
            std::ldexp(static_cast<double>(random() % 2 == 0 ? whole : -whole), unit[axis]);
      }
    // With halved sums of two points the fourth is in the plane of the others, exactly or nearly.
    if (i % 2 == 0) p[3] = 0.5 * p[1] + 0.5 * p[2];
    const int expected = rational_orientation(p[0], p[1], p[2], p[3]);
    flat += expected == 0;
    ASSERT_EQ(orientation(p[0], p[1], p[2], p[3]), expected);
    ASSERT_EQ(exact_orientation(p[0], p[1], p[2], p[3]), expected);
    for (unsigned axis = 0; axis < 3; ++axis)
      ASSERT_EQ(exact_normal_sign(p[0], p[1], p[2], axis),
                rational_normal_sign(p[0], p[1], p[2], axis));
  }
  EXPECT_GT(flat, 1000);
  EXPECT_GT(wide, 300);
}

TEST(Predicates, OrientationIsExactForTheWidestExponentRange) {
  const Point a(0, 0, 0), b(0x1p300, 0, 0), c(0, 0x1p300, 0x1p-1074);
  EXPECT_EQ(orientation(a, b, c, {-0x1p300, -0x1p300, 0}), 1);
  EXPECT_EQ(orientation(a, b, c, {-0x1p300, 0, 0}), 0);
  EXPECT_EQ(orientation(a, b, c, {0, 0, -0x1p-1074}), -1);
  EXPECT_EQ(normal_sign(a, b, c, 0), 0);
  EXPECT_EQ(normal_sign(a, b, c, 1), -1);
  EXPECT_EQ(normal_sign(a, b, c, 2), 1);
}

TEST(Predicates, SignsDoNotDependOnTheModeOfTheThread) {
  std::mt19937_64 random(41);
  std::uniform_int_distribution<int> exponent(-1074, -1000);
  for (const int rounding : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO})
    for (int i = 0; i < 400; ++i) {
      Point points[4];
      for (Point& point : points) {
        point = on_ulp_grid(random);
        if (i % 3 == 0) point.z() = std::ldexp(1.0, exponent(random));
      }
      const int expected = rational_orientation(points[0], points[1], points[2], points[3]);
      const OddArithmetic odd(rounding);
      ASSERT_EQ(orientation(points[0], points[1], points[2], points[3]), expected);
    }
}

// Triangles of the cube from 0 to 2, facing outward.
std::vector<Triangle> cube() {
  const auto corner = [](unsigned i) { return Point(i & 1 ? 2 : 0, i & 2 ? 2 : 0, i & 4 ? 2 : 0); };
  const unsigned quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  std::vector<Triangle> triangles;
  for (const auto& quad : quads) {
    triangles.push_back({corner(quad[0]), corner(quad[1]), corner(quad[2])});
    triangles.push_back({corner(quad[0]), corner(quad[2]), corner(quad[3])});
  }
  return triangles;
}

int winding_change(const std::vector<Triangle>& triangles, const Point& from, const Point& to) {
  int change = 0;
  for (const Triangle& triangle : triangles) change += crossing({from, to}, triangle);
  return change;
}

// All integer points with coordinates from -1 to 3: on vertices, edges and faces of the cube, and
// in their planes and lines.
std::vector<Point> lattice() {
  std::vector<Point> points;
  for (int x = -1; x <= 3; ++x)
    for (int y = -1; y <= 3; ++y)
      for (int z = -1; z <= 3; ++z) points.emplace_back(x, y, z);
  return points;
}

TEST(Crossings, CountTheWindingNumberOfLatticePoints) {
  const Point outside(-7, -9, -8);
  for (const Point& point : lattice()) {
    // Points are perturbed by a positive step: the lower faces are inside, the upper ones outside.
    const bool inside = point.minCoeff() >= 0 && point.maxCoeff() < 2;
    EXPECT_EQ(winding_change(cube(), point, outside), inside) << point.transpose();
  }
}

TEST(Crossings, AgreeAlongAnyPath) {
  const Point outside(-7, -9, -8);
  const auto points = lattice();
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i % 3; j < points.size(); j += 3) {
      const Point &from = points[i], &to = points[j];
      ASSERT_EQ(winding_change(cube(), from, to) + winding_change(cube(), to, outside),
                winding_change(cube(), from, outside))
          << from.transpose() << " to " << to.transpose();
    }
}

TEST(Crossings, CountDoubledAndInvertedSurfaces) {
  const Point centre(1, 1, 1), outside(9, 1, 1);
  auto doubled = cube();
  for (const Triangle& triangle : cube()) doubled.push_back(triangle);
  EXPECT_EQ(winding_change(doubled, centre, outside), 2);
  auto turned = cube();
  for (Triangle& triangle : turned) std::swap(triangle[0], triangle[1]);
  EXPECT_EQ(winding_change(turned, centre, outside), -1);
  EXPECT_EQ(winding_change(cube(), outside, centre), -1);
}

TEST(Crossings, IgnoreTrianglesWithoutArea) {
  const Point p(0, 0, -1), q(0, 0, 1);
  EXPECT_EQ(crossing({p, q}, {Point(-1, 0, 0), Point(1, 0, 0), Point(0, 0, 0)}), 0);
  EXPECT_EQ(crossing({p, q}, {Point(0, 0, 0), Point(0, 0, 0), Point(0, 0, 0)}), 0);
  EXPECT_NE(crossing({p, q}, {Point(-1, -1, 0), Point(1, -1, 0), Point(0, 1, 0)}), 0);
}

// A grid so coarse that most points are in the plane of a face, on an edge or at a vertex.
TEST(Predicates, LiesOnIsExactOnALattice) {
  std::mt19937_64 random(33);
  std::uniform_int_distribution<int> step(0, 3);
  const auto index = [&] { return Point(step(random), step(random), step(random)); };
  int on = 0;
  for (int i = 0; i < 20000; ++i) {
    const Triangle triangle{index(), index(), index()};
    const Point point = i % 2 == 0 ? index() : Point(index() * 0.5);
    // These coordinates have few bits: no square is rounded, and zero means contact.
    const bool expected = triangle_value(point, triangle).squared == 0;
    ASSERT_EQ(lies_on(point, triangle), expected)
        << point.transpose() << " on " << triangle[0].transpose() << ", " << triangle[1].transpose()
        << ", " << triangle[2].transpose();
    on += expected;
  }
  EXPECT_GT(on, 200);
}

TEST(Predicates, LiesOnDistinguishesUlps) {
  const Triangle triangle{Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)};
  EXPECT_TRUE(lies_on({0.5, 0.5, 0}, triangle));
  EXPECT_FALSE(lies_on({0.5, std::nextafter(0.5, 1.0), 0}, triangle));
  EXPECT_FALSE(lies_on({0.25, 0.25, 0x1p-1074}, triangle));
  EXPECT_FALSE(lies_on({0.25, -0x1p-1074, 0}, triangle));
  EXPECT_TRUE(lies_on({0.25, 0x1p-1074, 0}, triangle));
}

}  // namespace
}  // namespace planetree::octree
