#include "octree/mask/side_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "tests/octree/mask/random_side_grid.h"
#include "tests/octree/support/each_target.h"

namespace planetree::octree {
namespace {

using SideGridLookupTest = RandomSideGrid;

// Also with points in the input's units.
TEST_F(SideGridLookupTest, FastLookupAgreesWithLook) {
  MaskPages pages(random_mask(10), 65536, kRandomMaskPage);
  for (const int scale : {0, 3, -200, 900, -900}) {
    SideGrid grid;
    memory_.resize(kMany);
    grid.fill(pages.mask(lower_), tree_of(lower_, size_), CapGrid(), false, scale, pages.reader(),
              memory_);
    std::size_t known = 0, certain = 0;
    for (const Point& point : points(4000)) {
      const Point input = point * std::ldexp(1.0, -scale);
      const int winding = grid.look(point).winding, found_fast = find_fast(grid, input);
      known += winding != SideGrid::kUnknown;
      certain += found_fast != SideGrid::kUnknown;
      ASSERT_TRUE(found_fast == SideGrid::kUnknown || found_fast == winding) << point.transpose();
    }
    // Half of the points are on cell sides, where the fast lookup is uncertain.
    EXPECT_GT(certain, known * 2 / 5) << scale;
    EXPECT_LT(certain, known) << scale;
  }
}

TEST_F(SideGridLookupTest, FastLookupIsTheSameOnEveryInstructionSet) {
  MaskPages pages(random_mask(10), 65536, kRandomMaskPage);
  std::vector<Point> all = points(4000);
  for (const double far : {1e-300, 1e-9, 3.0, 1e9, 1e300})
    for (const Point& point : points(100)) all.push_back(far * (point - lower_ - size_ / 2));
  // Around the ends of the uncertainty band of cell faces, in half fixed-point steps of several
  // levels.
  for (const Point& point : points(20000)) {
    const auto turn = static_cast<int>(all.size());
    const double off = std::ldexp(turn % 1025 - 512.5, -34 - turn % 6);
    all.push_back(point);
    all.back()[0] = lower_[0] + std::floor((point[0] - lower_[0]) * 256) / 256 + off;
  }
  const auto fast_lookups = on_each_target([&] {
    const SideGrid grid = grid_of(pages, kMany);
    std::vector<int> found;
    for (const Point& point : all) found.push_back(find_fast(grid, point));
    return found;
  });
  for (const std::vector<int>& found : fast_lookups) {
    EXPECT_EQ(found, fast_lookups[0]);
    // All three results occur: outside, inside, unknown.
    EXPECT_EQ(std::set<int>(found.begin(), found.end()).size(), 3u);
  }
}

TEST_F(SideGridLookupTest, FastLookupIsUnknownOutOfRange) {
  MaskPages pages(random_mask(10), 65536, kRandomMaskPage);
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (const int scale : {0, 901, -901}) {
    SideGrid grid;
    memory_.resize(kMany);
    grid.fill(pages.mask(lower_), tree_of(lower_, size_), CapGrid(), false, scale, pages.reader(),
              memory_);
    for (const double value : {infinite, -infinite, std::nan(""), 1e300, -1e300})
      for (unsigned axis = 0; axis < 3; ++axis) {
        Point point = lower_ + size_ / 2;
        point[axis] = value;
        EXPECT_EQ(find_fast(grid, point), SideGrid::kUnknown) << value;
      }
    for (const Point& point : points(scale == 0 ? 0 : 100))
      EXPECT_EQ(find_fast(grid, point), SideGrid::kUnknown) << scale;
  }
}

}  // namespace
}  // namespace planetree::octree
