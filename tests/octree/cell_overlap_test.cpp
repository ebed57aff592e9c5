#include "octree/build/cell_overlap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include <Eigen/Geometry>

#include "tests/octree/exact_overlap.h"
#include "tests/octree/sample_tree.h"

namespace planetree::octree {
namespace {

struct Pair {
  Triangle triangle;
  Point lower, upper;
};

Point any_point(Noise& noise, double low, double high) {
  const Vec3 at = noise.point(low, high);
  return {at.x, at.y, at.z};
}

// All 53 bits.
Point full_point(Noise& noise, double low, double high) {
  return any_point(noise, low, high) + 0x1p-31 * any_point(noise, low, high);
}

double sign(Noise& noise) { return noise.bits() % 2 == 0 ? 1 : -1; }

double next(double value, int steps) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (; steps > 0; --steps) value = std::nextafter(value, kInfinity);
  for (; steps < 0; ++steps) value = std::nextafter(value, -kInfinity);
  return value;
}

Pair random_pair(Noise& noise) {
  const Point lower = full_point(noise, -1, 1);
  const Point edge = full_point(noise, 0, 0.7);
  return {
      {full_point(noise, -1.5, 1.5), full_point(noise, -1.5, 1.5), full_point(noise, -1.5, 1.5)},
      lower,
      lower + edge};
}

// Long and so thin that its normal is mostly rounding.
Pair needle(Noise& noise) {
  Pair pair = random_pair(noise);
  pair.triangle[2] = pair.triangle[0] + 0.7 * (pair.triangle[1] - pair.triangle[0]) +
                     0x1p-50 * any_point(noise, -1, 1);
  return pair;
}

// From 2^-60 to 2^60 times as large as the box.
Pair of_other_size(Noise& noise) {
  Pair pair = random_pair(noise);
  const double factor = std::ldexp(1.0, static_cast<int>(noise.bits() % 121) - 60);
  const Point at = pair.lower;
  for (Point& corner : pair.triangle) corner = at + (corner - at) * factor;
  return pair;
}

// Products of such lengths underflow.
Pair tiny(Noise& noise) {
  Pair pair = random_pair(noise);
  const double factor = noise.bits() % 2 == 0 ? 1e-300 : 1e-160;
  for (Point& corner : pair.triangle) corner *= factor;
  pair.lower *= factor;
  pair.upper *= factor;
  return pair;
}

// A triangle of 1e-300 beside or in a corner of a box of 1.
Pair tiny_at_a_corner(Noise& noise) {
  Pair pair;
  pair.lower = Point(-1, 0, -1);
  pair.upper = Point(0, 1, 0);
  for (Point& corner : pair.triangle) corner = 1e-300 * any_point(noise, -1, 1);
  return pair;
}

// Few bits, so that much lies in one plane, line or point.
Pair on_lattice(Noise& noise) {
  const auto step = [&] { return static_cast<double>(noise.bits() % 7) - 3; };
  const auto place = [&] { return Point(step(), step(), step()); };
  const Point one = place(), other = place();
  return {{place(), place(), place()}, one.cwiseMin(other), one.cwiseMax(other)};
}

Pair axis_aligned(Noise& noise) {
  Pair pair = random_pair(noise);
  const unsigned axis = noise.bits() % 3;
  const double at = noise.bits() % 2 == 0 ? pair.lower[axis] : pair.upper[axis];
  for (Point& corner : pair.triangle)
    corner[axis] = next(at, static_cast<int>(noise.bits() % 3) - 1);
  return pair;
}

// A corner, edge or the inside of the triangle is on the box's corner or edge,
// and the rest of it is beyond; then a few last bits are changed.
Pair barely(Noise& noise) {
  Pair pair = random_pair(noise);
  const Point outward(sign(noise), sign(noise), sign(noise));
  Point at;
  for (unsigned axis = 0; axis < 3; ++axis)
    at[axis] = outward[axis] > 0 ? pair.upper[axis] : pair.lower[axis];
  // Of a plane that has the box on one side; of one that has an edge of it.
  Point normal = any_point(noise, 0.1, 1).cwiseProduct(outward);
  if (noise.bits() % 2 == 0) {
    const unsigned axis = noise.bits() % 3;
    at[axis] = noise.uniform(pair.lower[axis], pair.upper[axis]);
    normal[axis] = 0;
  }
  const auto in_plane = [&] { return Point(normal.cross(any_point(noise, -1, 1))); };
  const Point u = in_plane(), v = in_plane();
  switch (noise.bits() % 3) {
    case 0:
      pair.triangle = {at, at + u, at + v};
      break;
    case 1:
      pair.triangle = {at - u, at + 0.5 * u, at + v};
      break;
    default:
      pair.triangle = {at + u, at + v, at - u - v};
      break;
  }
  for (Point& corner : pair.triangle)
    for (double& value : corner) value = next(value, static_cast<int>(noise.bits() % 5) - 2);
  std::rotate(pair.triangle.begin(), pair.triangle.begin() + noise.bits() % 3, pair.triangle.end());
  return pair;
}

// As far from the origin as coordinates go; cells there are flat or so.
Pair far_away(Noise& noise) {
  Pair pair = barely(noise);
  const Point offset(0x1p54, -0x1p53, 0x1p30);
  for (Point& corner : pair.triangle) corner += offset;
  pair.lower += offset;
  pair.upper += offset;
  return pair;
}

struct Outcome {
  int touching = 0, apart = 0, told_apart = 0;
};

Outcome try_out(Pair (*make)(Noise&), int count) {
  Noise noise(11);
  Outcome outcome;
  for (int i = 0; i < count; ++i) {
    const Pair pair = make(noise);
    const bool found = may_touch(pair.triangle, pair.lower, pair.upper);
    const bool exact = exactly_touches(pair.triangle, pair.lower, pair.upper);
    EXPECT_TRUE(found || !exact) << "case " << i;
    ++(exact ? outcome.touching : outcome.apart);
    outcome.told_apart += !found;
  }
  return outcome;
}

TEST(CellOverlap, NeverMissesATriangle) {
  struct Case {
    const char* name;
    Pair (*make)(Noise&);
    int count;
    int least_told;  ///< percent of those that are apart
  };
  // What is apart by the last bits, or below the least numbers, need not be told.
  for (const Case& c :
       {Case{"random", random_pair, 800, 99}, Case{"needle", needle, 800, 98},
        Case{"of other size", of_other_size, 500, 95}, Case{"tiny", tiny, 200, 30},
        Case{"tiny at a corner", tiny_at_a_corner, 200, 5},
        Case{"on a lattice", on_lattice, 2500, 99}, Case{"axis-aligned", axis_aligned, 500, 60},
        Case{"barely", barely, 1500, 0}, Case{"far away", far_away, 400, 0}}) {
    SCOPED_TRACE(c.name);
    const Outcome outcome = try_out(c.make, c.count);
    EXPECT_GT(outcome.touching, c.count / 100);
    EXPECT_GT(outcome.apart, c.count / 100);
    EXPECT_GE(100 * outcome.told_apart, c.least_told * outcome.apart)
        << outcome.told_apart << " of " << outcome.apart;
  }
}

TEST(CellOverlap, FindsWhatSharesOnePoint) {
  const Point lower(-1, -1, -1), upper(1, 1, 1);
  const auto touches = [&](const Point& a, const Point& b, const Point& c) {
    return may_touch({a, b, c}, lower, upper) && exactly_touches({a, b, c}, lower, upper);
  };
  // A vertex of it at a corner, an edge and a face of the box.
  for (const Point& at : {Point(1, 1, 1), Point(1, 1, 0.25), Point(0.25, 0.5, 1)})
    EXPECT_TRUE(touches(at, at + Point(1, 2, 3), at + Point(2, 1, 1)));
  // An edge of it, then its inside, at a corner and an edge.
  for (const Point& at : {Point(1, 1, 1), Point(1, 1, 0.25)}) {
    const Point along(2, -2, 0);
    EXPECT_TRUE(touches(at - along, at + along, at + Point(4, 4, 8)));
    EXPECT_TRUE(touches(at - along, at + along + Point(0, 0, 1), at + along - Point(0, 0, 1)));
  }
  EXPECT_TRUE(touches({3, -1, 1}, {-1, 3, 1}, {3, 3, 5}));
  EXPECT_TRUE(touches({3, 0, 0}, {0, 3, 0}, {0, 0, 3}));
  EXPECT_TRUE(touches({-5, -5, 1}, {5, -5, 1}, {0, 9, 1}));
}

TEST(CellOverlap, FindsTrianglesWithoutArea) {
  const Point lower(0, 0, 0), upper(1, 1, 1), inside(0.5, 0.5, 0.5), outside(1.25, 0, 0);
  EXPECT_TRUE(may_touch({inside, inside, inside}, lower, upper));
  EXPECT_TRUE(may_touch({upper, upper, upper}, lower, upper));
  EXPECT_TRUE(
      may_touch({Point(-1, 0.5, 2.5), Point(0.5, 0.5, 1), Point(2, 0.5, -0.5)}, lower, upper));
  EXPECT_FALSE(may_touch({outside, outside, outside}, lower, upper));
  EXPECT_FALSE(
      may_touch({Point(2.5, 0.5, 0), Point(1.5, 0.5, 1), Point(0, 0.5, 2.5)}, lower, upper));
}

TEST(CellOverlap, FindsTrianglesInAFlatBox) {
  const Point lower(0, 0, 0.5), upper(1, 1, 0.5);
  EXPECT_TRUE(may_touch({Point(0, 0, 0), Point(1, 0, 1), Point(0, 1, 1)}, lower, upper));
  EXPECT_TRUE(may_touch({Point(0, 0, 0.5), Point(1, 0, 1), Point(0, 1, 1)}, lower, upper));
  EXPECT_FALSE(may_touch({Point(0, 0, 0.75), Point(1, 0, 1), Point(0, 1, 1)}, lower, upper));
  EXPECT_TRUE(may_touch({lower, lower, upper}, upper, upper));
}

TEST(CellOverlap, HoldsDifferencesAsLargeAsItSays) {
  const double far = 0x1p499;
  const Point lower(0, 0, 0), upper(1, 1, 1);
  EXPECT_TRUE(may_touch({Point(-far, -far, -far), Point(far, far, far), Point(far, -far, 0)}, lower,
                        upper));
  const double less = 0x1p300;
  EXPECT_FALSE(may_touch({Point(less, 0, 0), Point(0, less, 0), Point(0, 0, less)}, lower, upper));
}

// The 13 axes of a triangle and a box.
std::array<Point, 13> axes_of(const Triangle& triangle) {
  std::array<Point, 13> axes;
  for (unsigned axis = 0; axis < 3; ++axis) axes[axis] = Point::Unit(axis);
  axes[3] = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  for (unsigned edge = 0; edge < 3; ++edge)
    for (unsigned axis = 0; axis < 3; ++axis)
      axes[4 + 3 * edge + axis] =
          (triangle[(edge + 1) % 3] - triangle[edge]).cross(Point(Point::Unit(axis)));
  return axes;
}

// The gap between the projections on an axis, as a share of the axis' length.
double gap_along(const Point& axis, const Pair& pair) {
  const Point centre = (pair.lower + pair.upper) * 0.5, half = pair.upper - centre;
  const double reach = axis.cwiseAbs().dot(half);
  double least = 1e300, greatest = -1e300;
  for (const Point& corner : pair.triangle) {
    least = std::min(least, axis.dot(corner - centre));
    greatest = std::max(greatest, axis.dot(corner - centre));
  }
  return std::max(least - reach, -greatest - reach) / axis.norm();
}

// Of pairs that one axis alone tells apart, and clearly so.
TEST(CellOverlap, TellsApartAlongEachOfThirteenAxes) {
  std::array<int, 13> told{};
  Noise noise(3);
  for (int i = 0; i < 40000; ++i) {
    const Pair pair = random_pair(noise);
    const auto axes = axes_of(pair.triangle);
    unsigned separating = 0, last = 0;
    bool clear = true;
    for (unsigned axis = 0; axis < 13; ++axis) {
      const double gap = gap_along(axes[axis], pair);
      if (gap <= 0) continue;
      clear = gap > 1e-9;
      last = axis;
      ++separating;
    }
    if (separating != 1 || !clear) continue;
    ++told[last];
    ASSERT_FALSE(may_touch(pair.triangle, pair.lower, pair.upper)) << "axis " << last;
  }
  for (unsigned axis = 0; axis < 13; ++axis) EXPECT_GT(told[axis], 0) << "axis " << axis;
}

}  // namespace
}  // namespace planetree::octree
