#include "octree/geometry/cell_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

constexpr std::uint32_t kMax = (1u << kLevels) - 1;

std::vector<Point> min_corners() {
  return {{0, 0, 0},
          {-0.1, 1.0 / 3, 0.7},
          {0x1p52 + 1, -0x1p52, 0x1p51 + 0.5},
          {0x1p54, -0x1p54, 0x1p54 - 2},
          {0x1p34 + 0.3, 1e-300, -1e-9}};
}

GridCell any_cell(Noise& noise, unsigned level) {
  const std::uint32_t mask = (1u << level) - 1;
  return {level, {noise.bits() & mask, noise.bits() & mask, noise.bits() & mask}};
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void expect_same(const Point& a, const Point& b) {
  for (unsigned axis = 0; axis < 3; ++axis) EXPECT_TRUE(same_bits(a[axis], b[axis])) << axis;
}

TEST(CellGrid, RootIsTheCubeOfSideTwo) {
  const CellGrid grid({1, 2, 3});
  expect_same(grid.lower({}), {1, 2, 3});
  expect_same(grid.upper({}), {3, 4, 5});
  expect_same(grid.middle({}), {2, 3, 4});
  const GridCell finest{kLevels, {kMax, 0, 1}};
  expect_same(grid.lower(finest), {3 - 0x1p-18, 2, 3 + 0x1p-18});
  expect_same(grid.upper(finest), {3, 2 + 0x1p-18, 3 + 0x1p-17});
}

TEST(CellGrid, RoundsEachSideOnce) {
  Noise noise(1);
  for (const Point& lower : min_corners()) {
    const CellGrid grid(lower);
    for (unsigned level = 0; level <= kLevels; ++level) {
      const GridCell cell = any_cell(noise, level);
      for (unsigned axis = 0; axis < 3; ++axis) {
        const double offset = std::ldexp(cell.at[axis], 1 - static_cast<int>(level));
        const double upper = std::ldexp(cell.at[axis] + 1.0, 1 - static_cast<int>(level));
        EXPECT_TRUE(same_bits(grid.lower(cell)[axis], lower[axis] + offset));
        EXPECT_TRUE(same_bits(grid.upper(cell)[axis], lower[axis] + upper));
      }
    }
  }
}

TEST(CellGrid, NumbersChildrenAndCornersByBits) {
  const GridCell cell{3, {1, 6, 2}};
  const CellGrid grid({0, 0, 0});
  for (unsigned i = 0; i < 8; ++i) {
    const GridCell child = cell.child(i);
    EXPECT_EQ(child.level, 4u);
    EXPECT_EQ(child.at[0], 2 * cell.at[0] + (i & 1u));
    EXPECT_EQ(child.at[1], 2 * cell.at[1] + (i >> 1 & 1u));
    EXPECT_EQ(child.at[2], 2 * cell.at[2] + (i >> 2 & 1u));
    const Point corner = grid.corner(cell, i);
    for (unsigned axis = 0; axis < 3; ++axis)
      EXPECT_EQ(corner[axis], (i >> axis & 1 ? grid.upper(cell) : grid.lower(cell))[axis]);
  }
}

TEST(CellGrid, NeighboursShareSidesBitForBit) {
  Noise noise(2);
  for (const Point& lower : min_corners()) {
    const CellGrid grid(lower);
    for (unsigned level = 1; level <= kLevels; ++level) {
      const GridCell cell = any_cell(noise, level);
      for (unsigned axis = 0; axis < 3; ++axis) {
        if (cell.at[axis] == (1u << level) - 1) continue;
        GridCell neighbour = cell;
        ++neighbour.at[axis];
        for (unsigned corner = 0; corner < 8; ++corner)
          if ((corner >> axis & 1) != 0)
            expect_same(grid.corner(cell, corner), grid.corner(neighbour, corner ^ 1u << axis));
      }
    }
  }
}

// A corner therefore has the same coordinates whichever cell it belongs to.
TEST(CellGrid, ChildrenShareSidesWithTheirParent) {
  Noise noise(3);
  for (const Point& lower : min_corners()) {
    const CellGrid grid(lower);
    for (unsigned level = 0; level < kLevels; ++level) {
      const GridCell cell = any_cell(noise, level);
      const Point middle = grid.middle(cell);
      for (unsigned i = 0; i < 8; ++i) {
        expect_same(grid.corner(cell.child(i), i), grid.corner(cell, i));
        expect_same(grid.corner(cell.child(i), 7 - i), middle);
      }
    }
  }
}

TEST(CellGrid, SidesNeverCross) {
  for (const Point& lower : min_corners()) {
    const CellGrid grid(lower);
    Point before = lower;
    for (std::uint32_t i = 0; i < 4096; ++i) {
      const GridCell cell{12, {i, i, i}};
      EXPECT_TRUE((grid.lower(cell).array() >= before.array()).all());
      EXPECT_TRUE((grid.upper(cell).array() >= grid.lower(cell).array()).all());
      EXPECT_TRUE((grid.middle(cell).array() >= grid.lower(cell).array()).all());
      EXPECT_TRUE((grid.middle(cell).array() <= grid.upper(cell).array()).all());
      before = grid.upper(cell);
    }
  }
}

TEST(CellGrid, CellsMayBeFlatFarFromTheOrigin) {
  const CellGrid grid({0x1p54, 0, 0x1p52});
  const GridCell cell{5, {3, 3, 3}};
  EXPECT_EQ(grid.lower(cell).x(), grid.upper(cell).x());
  EXPECT_LT(grid.lower(cell).y(), grid.upper(cell).y());
  EXPECT_EQ(grid.lower(cell).z(), grid.upper(cell).z());
}

// The cell at level 19 reached by halving the cube again and again.
GridCell halved(const CellGrid& grid, const Point& point) {
  GridCell cell;
  while (cell.level < kLevels) {
    const Point middle = grid.middle(cell);
    unsigned octant = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
      octant |= static_cast<unsigned>(point[axis] >= middle[axis]) << axis;
    cell = cell.child(octant);
  }
  return cell;
}

TEST(CellGrid, FinestCellMatchesRepeatedHalving) {
  Noise noise(7);
  for (const Point& lower : min_corners()) {
    const CellGrid grid(lower);
    for (int i = 0; i < 3000; ++i) {
      const Vec3 in = noise.point(0, 2);
      Point point = lower + Point(in.x, in.y, in.z);
      // Also points on cell sides, and one ulp below them.
      if (i % 3 == 1) point = grid.lower(any_cell(noise, 1 + noise.bits() % kLevels));
      if (i % 3 == 2) point = grid.upper(any_cell(noise, 1 + noise.bits() % kLevels));
      if (i % 2 == 1)
        for (double& at : point) at = std::max(std::nextafter(at, -1e300), lower.minCoeff());
      point = point.cwiseMax(lower);
      EXPECT_EQ(grid.finest(point).at, halved(grid, point).at);
    }
  }
}

TEST(CellGrid, AncestorsAreTheCellsAbove) {
  Noise noise(8);
  GridCell cell;
  std::vector<GridCell> above{cell};
  while (cell.level < kLevels) above.push_back(cell = cell.child(noise.bits() % 8));
  for (const GridCell& expected : above) {
    EXPECT_EQ(cell.ancestor(expected.level).level, expected.level);
    EXPECT_EQ(cell.ancestor(expected.level).at, expected.at);
  }
}

TEST(CellGrid, OctcodesMatchMortonPrefixes) {
  EXPECT_EQ(GridCell{}.octcode(), 0u);
  EXPECT_EQ(GridCell{}.child(5).octcode(), octcode_of_prefix(std::uint64_t{5} << 54, 3));
  Noise noise(4);
  for (unsigned level = 0; level <= kLevels; ++level) {
    const GridCell cell = any_cell(noise, level);
    const Cell back = cell_of_octcode(cell.octcode());
    EXPECT_EQ(back.level, level);
    EXPECT_EQ(back.within, 0u);
    EXPECT_EQ(back.x, cell.at[0]);
    EXPECT_EQ(back.y, cell.at[1]);
    EXPECT_EQ(back.z, cell.at[2]);
    if (level == kLevels) continue;
    // The Morton code of any finest cell within it begins with its own.
    GridCell inner = cell;
    while (inner.level < kLevels) inner = inner.child(noise.bits() % 8);
    const std::uint64_t morton = morton_code(inner.at[0], inner.at[1], inner.at[2]);
    EXPECT_EQ(cell.octcode(), octcode_of_prefix(morton, 3 * level));
    for (unsigned i = 0; i < 8; ++i) {
      EXPECT_LT(cell.octcode(), cell.child(i).octcode());
      if (i > 0) {
        EXPECT_LT(cell.child(i - 1).octcode(), cell.child(i).octcode());
      }
    }
  }
}

}  // namespace
}  // namespace planetree::octree
