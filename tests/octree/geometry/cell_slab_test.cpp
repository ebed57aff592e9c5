#include "octree/geometry/cell_slab.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "octree/builder/mask/slab_fit.h"
#include "octree/winding/crossings.h"
#include "tests/octree/support/exact_overlap.h"
#include "tests/octree/support/sample_mask.h"
#include "tests/octree/support/triangle_and_box.h"

namespace planetree::octree {
namespace {

template <class Call>
void each_direction(const Call& call) {
  for (unsigned axis = 0; axis < 3; ++axis)
    for (int p = -CellSlab::kSteps; p <= CellSlab::kSteps; ++p)
      for (int q = -CellSlab::kSteps; q <= CellSlab::kSteps; ++q) {
        CellSlab slab;
        slab.direction = CellSlab::make_direction(axis, p, q);
        call(slab, axis, p, q);
      }
}

TEST(CellSlab, RoundTripsThroughItsWord) {
  each_direction([](CellSlab slab, unsigned axis, int p, int q) {
    slab.lower = 17;
    slab.upper = 200;
    EXPECT_EQ(CellSlab::of_word(slab.word()), slab);
    EXPECT_TRUE(slab.direction_is_valid());
    EXPECT_EQ(slab.axis(), axis);
    EXPECT_EQ(slab.p(), p);
    EXPECT_EQ(slab.q(), q);
  });
  for (const std::uint16_t direction :
       {CellSlab::make_direction(3, 0, 0), CellSlab::make_direction(0, 33, 0),
        CellSlab::make_direction(2, 0, 33)}) {
    CellSlab slab;
    slab.direction = direction;
    EXPECT_FALSE(slab.direction_is_valid());
  }
}

TEST(CellSlab, HeightsRunFromLowestToHighestCorner) {
  each_direction([](const CellSlab& slab, unsigned, int, int) {
    std::vector<double> heights;
    for (unsigned corner = 0; corner < 8; ++corner)
      heights.push_back(slab.height(Point(corner & 1, corner >> 1 & 1, corner >> 2)));
    const auto [least, greatest] = std::minmax_element(heights.begin(), heights.end());
    EXPECT_EQ(*least, 0);
    EXPECT_EQ(*greatest, slab.width());
    EXPECT_EQ(heights[slab.highest_corner()], *greatest);
    EXPECT_EQ(heights[7 - slab.highest_corner()], *least);
  });
}

TEST(CellSlab, DecidesOnlyPointsBeyondAPlane) {
  CellSlab slab;  // width 32
  EXPECT_FALSE(slab.has_plane());
  for (const double height : {-1.0, 0.0, 16.0, 32.0, 33.0}) EXPECT_EQ(slab.side_of(height), 0);
  slab.lower = 64;
  slab.upper = 127;
  EXPECT_TRUE(slab.has_plane());
  EXPECT_EQ(slab.side_of(8), -1);
  EXPECT_EQ(slab.side_of(8.001), 0);
  EXPECT_EQ(slab.side_of(15.999), 0);
  EXPECT_EQ(slab.side_of(16), 1);
}

/// Triangles about a cell: a nearly flat surface, a rough one, or a few random triangles.
std::vector<BoxedTriangle> triangles_about(const Point& middle, double size, Noise& noise) {
  std::vector<BoxedTriangle> triangles;
  const Point normal = any_point(noise, -1, 1);
  const double rough = noise.bits() % 3 == 0 ? 1 : 0.05 * noise.uniform(0, 1);
  for (unsigned count = 1 + noise.bits() % 20; count > 0; --count) {
    Triangle triangle;
    for (Point& corner : triangle) {
      const Point way = any_point(noise, -1, 1);
      const Point flat = way - normal * (normal.dot(way) / normal.squaredNorm());
      corner = middle + size * (flat + rough * (way - flat));
    }
    triangles.emplace_back(triangle);
  }
  return triangles;
}

// Compares exactly with small boxes in the cell: a box beyond a plane must touch no triangle.
TEST(CellSlab, EnclosesTheSurfaceInItsCell) {
  Noise noise(12);
  unsigned certain = 0, empty = 0;
  for (int i = 0; i < 400 && !testing::Test::HasFailure(); ++i) {
    const CellGrid grid(full_point(noise, -1, 1));
    GridCell cell{.level = 3 + static_cast<unsigned>(noise.bits() % 17)};
    for (std::uint32_t& at : cell.at) at = noise.bits() % (1U << cell.level);
    const Point lower = grid.lower(cell), size = grid.upper(cell) - lower;
    const auto triangles = triangles_about(lower + size * 0.5, size.x(), noise);
    std::vector<std::uint32_t> positions;
    for (std::uint32_t k = 0; k < triangles.size(); ++k) positions.push_back(k);
    const CellSlab slab = fit_slab(cell, lower, triangles, positions);
    EXPECT_TRUE(slab.direction_is_valid());
    EXPECT_LE(slab.lower, slab.upper);
    empty += !slab.has_plane();
    for (int k = 0; k < 20; ++k) {
      // A small box; skipped unless all its corners are beyond the same plane.
      const Point u = any_point(noise, 0, 0.99), from = lower + size.cwiseProduct(u);
      const Point to = from + size * (0.01 * noise.uniform(0, 1));
      const int side = slab.side_of(slab.height(CellSlab::position_in(from, lower, cell.level)));
      bool beyond = side != 0;
      for (unsigned corner = 1; corner < 8; ++corner) {
        const Point at(corner & 1 ? to.x() : from.x(), corner & 2 ? to.y() : from.y(),
                       corner & 4 ? to.z() : from.z());
        beyond = beyond &&
                 slab.side_of(slab.height(CellSlab::position_in(at, lower, cell.level))) == side;
      }
      if (!beyond) continue;
      ++certain;
      for (const BoxedTriangle& triangle : triangles)
        EXPECT_FALSE(exactly_touches(triangle.corners, from, to));
    }
  }
  EXPECT_GT(certain, 1000u);
  EXPECT_GT(empty, 20u);
}

TEST(CellSlab, IsEmptyWithoutAMeanNormal) {
  const Point at(0.5, 0.5, 0.5);
  const GridCell cell{.level = 1};
  const std::vector<BoxedTriangle> point{BoxedTriangle({at, at, at})};
  EXPECT_EQ(fit_slab(cell, Point::Zero(), point, {0}), CellSlab{});
  // Two faces whose normals cancel.
  const Triangle face{Point(0, 0, 0.5), Point(1, 0, 0.5), Point(0, 1, 0.5)};
  const std::vector<BoxedTriangle> both{BoxedTriangle(face),
                                        BoxedTriangle({face[0], face[2], face[1]})};
  EXPECT_EQ(fit_slab(cell, Point::Zero(), both, {0, 1}), CellSlab{});
}

TEST(CellSlab, IsOneStepWideAroundAPlane) {
  const Triangle face{Point(-1, -1, 0.5), Point(3, -1, 0.5), Point(-1, 3, 0.5)};
  const std::vector<BoxedTriangle> triangles{BoxedTriangle(face)};
  const CellSlab slab = fit_slab({.level = 1}, Point::Zero(), triangles, {0});
  EXPECT_EQ(slab.axis(), 2u);
  EXPECT_EQ(slab.p(), 0);
  EXPECT_EQ(slab.q(), 0);
  EXPECT_EQ(slab.lower, 127);
  EXPECT_EQ(slab.upper, 128);
}

}  // namespace
}  // namespace planetree::octree
