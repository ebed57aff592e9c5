#include "octree/builder/surface/edge_crossings.h"

#include <gtest/gtest.h>

#include "octree/builder/surface/edge_count.h"
#include "tests/octree/support/triangle_and_box.h"

namespace planetree::octree {
namespace {

std::array<Point, 8> corners_of(const TriangleAndBox& pair) {
  std::array<Point, 8> corners;
  for (unsigned which = 0; which < 8; ++which)
    for (unsigned axis = 0; axis < 3; ++axis)
      corners[which][axis] = (which >> axis & 1) != 0 ? pair.upper[axis] : pair.lower[axis];
  return corners;
}

// A triangle about an edge of the box, through it or just beside, so that crossings are frequent.
TriangleAndBox about_an_edge(Noise& noise) {
  TriangleAndBox pair = random_pair(noise);
  const unsigned axis = noise.bits() % 3;
  Point at = pair.lower;
  for (unsigned k = 0; k < 3; ++k)
    if (noise.bits() % 2 == 0) at[k] = pair.upper[k];
  at[axis] = noise.uniform(pair.lower[axis], pair.upper[axis]);
  const double size = std::ldexp(1.0, -static_cast<int>(noise.bits() % 40));
  for (Point& corner : pair.triangle) corner = at + size * any_point(noise, -1, 1);
  if (noise.bits() % 4 == 0) pair.triangle[0] = at;
  if (noise.bits() % 8 == 0) pair.triangle[1][axis] = pair.triangle[2][axis];
  return pair;
}

TriangleAndBox about_a_tiny_edge(Noise& noise) {
  TriangleAndBox pair = about_an_edge(noise);
  const double factor = std::ldexp(1.0, -490 - static_cast<int>(noise.bits() % 60));
  for (Point& corner : pair.triangle) corner *= factor;
  pair.lower *= factor;
  pair.upper *= factor;
  return pair;
}

void expect_exact(TriangleAndBox (*make)(Noise&), unsigned min_crossings) {
  Noise noise(6);
  unsigned crossings = 0;
  for (int i = 0; i < 4000 && !testing::Test::HasFailure(); ++i) {
    const TriangleAndBox pair = make(noise);
    const auto corners = corners_of(pair);
    const std::vector<BoxedTriangle> triangles{BoxedTriangle(pair.triangle)};
    const EdgeCount count(corners, 5, triangles, {0});
    std::array<std::int64_t, 8> winding{5};
    for (unsigned which = 1; which < 8; ++which)
      for (unsigned lower = which; lower != 0; lower &= lower - 1) {
        const unsigned before = which & ~(lower & -lower);
        const PerturbedSegment segment{corners[which], corners[before]};
        const int exact = crossing(segment, pair.triangle);
        const DownwardSegment down(segment, axis_of_edge(which, before));
        EXPECT_EQ(down.crossing(triangles[0]), exact);
        EXPECT_EQ(count.rise(which, before), exact);
        if (before == (which & (which - 1))) winding[which] = winding[before] + exact;
        crossings += exact != 0;
      }
    EXPECT_EQ(count.all(), winding);
  }
  EXPECT_GE(crossings, min_crossings);
}

TEST(EdgeCrossings, MatchExactPredicates) {
  expect_exact(random_pair, 100);
  expect_exact(about_an_edge, 300);
  expect_exact(needle, 0);
  expect_exact(of_other_size, 100);
  expect_exact(on_lattice, 100);
  expect_exact(axis_aligned, 10);
  expect_exact(barely, 10);
  expect_exact(far_away, 0);
}

// Differences whose products underflow.
TEST(EdgeCrossings, AreExactWhereDoublesUnderflow) {
  expect_exact(tiny, 10);
  expect_exact(about_a_tiny_edge, 300);
  expect_exact(tiny_at_a_corner, 10);
}

}  // namespace
}  // namespace planetree::octree
