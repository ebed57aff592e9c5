#include "octree/geometry/cell_overlap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include <Eigen/Geometry>

#include "tests/octree/support/exact_overlap.h"
#include "tests/octree/support/triangle_and_box.h"

namespace planetree::octree {
namespace {

struct Outcome {
  int touching = 0, apart = 0, separated = 0;
};

Outcome try_out(TriangleAndBox (*make)(Noise&), int count) {
  Noise noise(11);
  Outcome outcome;
  for (int i = 0; i < count; ++i) {
    const TriangleAndBox pair = make(noise);
    const bool found = may_touch(pair.triangle, pair.lower, pair.upper);
    const bool exact = exactly_touches(pair.triangle, pair.lower, pair.upper);
    EXPECT_TRUE(found || !exact) << "case " << i;
    ++(exact ? outcome.touching : outcome.apart);
    outcome.separated += !found;
  }
  return outcome;
}

TEST(CellOverlap, NeverMissesATriangle) {
  struct Case {
    const char* name;
    TriangleAndBox (*make)(Noise&);
    int count;
    int min_separated;  ///< minimum percentage of the separate pairs that the test must report
  };
  // Pairs that are separate only in the last bits, or below the smallest numbers, may be missed.
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
    EXPECT_GE(100 * outcome.separated, c.min_separated * outcome.apart)
        << outcome.separated << " of " << outcome.apart;
  }
}

TEST(CellOverlap, FindsTrianglesThatShareOnePoint) {
  const Point lower(-1, -1, -1), upper(1, 1, 1);
  const auto touches = [&](const Point& a, const Point& b, const Point& c) {
    return may_touch({a, b, c}, lower, upper) && exactly_touches({a, b, c}, lower, upper);
  };
  // A vertex of the triangle at a corner, on an edge and on a face of the box.
  for (const Point& at : {Point(1, 1, 1), Point(1, 1, 0.25), Point(0.25, 0.5, 1)})
    EXPECT_TRUE(touches(at, at + Point(1, 2, 3), at + Point(2, 1, 1)));
  // An edge of the triangle, then its interior, at a corner and on an edge of the box.
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

TEST(CellOverlap, HandlesTheLargestDifferencesWithoutOverflow) {
  const double far = 0x1p499;
  const Point lower(0, 0, 0), upper(1, 1, 1);
  EXPECT_TRUE(may_touch({Point(-far, -far, -far), Point(far, far, far), Point(far, -far, 0)}, lower,
                        upper));
  const double less = 0x1p300;
  EXPECT_FALSE(may_touch({Point(less, 0, 0), Point(0, less, 0), Point(0, 0, less)}, lower, upper));
}

// The 13 separating axes of a triangle and a box.
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

// The gap between the projections on an axis, divided by the axis' length.
double gap_along(const Point& axis, const TriangleAndBox& pair) {
  const Point centre = (pair.lower + pair.upper) * 0.5, half = pair.upper - centre;
  const double reach = axis.cwiseAbs().dot(half);
  double least = 1e300, greatest = -1e300;
  for (const Point& corner : pair.triangle) {
    least = std::min(least, axis.dot(corner - centre));
    greatest = std::max(greatest, axis.dot(corner - centre));
  }
  return std::max(least - reach, -greatest - reach) / axis.norm();
}

// Uses pairs that only one axis separates, and by a clear gap.
TEST(CellOverlap, SeparatesAlongEachOfThirteenAxes) {
  std::array<int, 13> certain{};
  Noise noise(3);
  for (int i = 0; i < 40000; ++i) {
    const TriangleAndBox pair = random_pair(noise);
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
    ++certain[last];
    ASSERT_FALSE(may_touch(pair.triangle, pair.lower, pair.upper)) << "axis " << last;
  }
  for (unsigned axis = 0; axis < 13; ++axis) EXPECT_GT(certain[axis], 0) << "axis " << axis;
}

}  // namespace
}  // namespace planetree::octree
