#include "octree/colour_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/octree/sample_mask.h"

namespace planetree::octree {
namespace {

constexpr std::uint64_t kMany = 1 << 20;  // triangles

class ColourMapTest : public testing::Test {
 protected:
  static TreeFacts tree_of(const Point& lower, const Point& size) {
    TreeFacts tree;
    tree.box_lower = lower;
    tree.box_upper = lower + size;
    return tree;
  }
  ColourMap map_of(MaskPages& pages, std::uint64_t triangles) {
    ColourMap map;
    memory_.resize(ColourMap::bytes(triangles));
    map.fill(pages.mask(lower_), tree_of(lower_, size_), triangles, pages.reader(), memory_);
    return map;
  }
  // Half of them on the sides of cells.
  std::vector<Point> points(std::size_t count) const {
    Noise noise(9);
    std::vector<Point> result;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 p = noise.point(0, 1);
      Point step = Point(p.x, p.y, p.z).cwiseProduct(size_);
      if (i % 2 == 0)
        for (double& value : step) value = std::floor(value * 32) / 32;
      result.push_back(lower_ + step);
    }
    return result;
  }
  MaskFinding look(MaskPages& pages, const Point& point) const {
    TreeWork work;
    return look_up(pages.mask(lower_), point, ~std::uint64_t{0}, pages.reader(), work);
  }

  const Point lower_{-0.25, 3, 1.0 / 3};
  const Point size_{1.2, 1.9, 0.7};
  std::vector<std::uint8_t> memory_;  // of the last map
};

TEST_F(ColourMapTest, SaysWhatTheMaskSays) {
  for (const std::uint32_t page_bytes : {4096u, 65536u}) {
    MaskPages pages(random_mask(10), page_bytes, 3);
    for (const std::uint64_t triangles : {std::uint64_t{1}, std::uint64_t{5000}, kMany}) {
      const ColourMap map = map_of(pages, triangles);
      std::size_t known = 0;
      for (const Point& point : points(4000)) {
        const int winding = map.winding(point);
        if (winding == ColourMap::kUnknown) continue;
        ++known;
        const MaskFinding found = look(pages, point);
        ASSERT_EQ(found.kind, MaskFinding::Kind::kColour) << point.transpose();
        ASSERT_EQ(winding, found.winding) << point.transpose();
      }
      EXPECT_GT(known, 0u) << triangles;
    }
  }
}

TEST_F(ColourMapTest, KnowsAllColoursDownToItsCells) {
  MaskPages pages(random_mask(6), 1 << 20);
  ASSERT_EQ(pages.size(), 1u);
  const ColourMap map = map_of(pages, kMany);
  // There are 39 * 61 * 23 cells of this level in the box, and too many of the next.
  constexpr unsigned kLevel = 6;
  std::size_t known = 0;
  const std::vector<Point> all = points(4000);
  for (std::size_t i = 1; i < all.size(); i += 2) {  // off the sides, where rounding may hide them
    const Point& point = all[i];
    const MaskFinding found = look(pages, point);
    const bool upper = found.kind == MaskFinding::Kind::kColour && found.cell.level <= kLevel;
    if (!upper) continue;
    ++known;
    ASSERT_EQ(map.winding(point), found.winding) << point.transpose();
  }
  EXPECT_GT(known, 500u);
}

TEST_F(ColourMapTest, TurnsSomePagesAndNoMore) {
  MaskPages pages(random_mask(10), 4096, 3);
  ASSERT_GT(pages.size(), 2u);
  map_of(pages, kMany);
  const std::vector<std::uint32_t> asked = pages.take_asked();
  EXPECT_EQ(asked.front(), 0u);
  EXPECT_GT(std::set<std::uint32_t>(asked.begin(), asked.end()).size(), 2u);
  EXPECT_LE(asked.size(), 1100u);
}

TEST_F(ColourMapTest, KnowsNothingWithoutTheFirstPage) {
  MaskPages pages(random_mask(10), 4096, 3);
  pages.withhold(0);
  const ColourMap map = map_of(pages, kMany);
  for (const Point& point : points(100)) EXPECT_EQ(map.winding(point), ColourMap::kUnknown);
}

TEST_F(ColourMapTest, KnowsNothingOutsideOfItsCells) {
  MaskPages pages(random_mask(10), 4096, 3);
  const ColourMap map = map_of(pages, kMany);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (unsigned axis = 0; axis < 3; ++axis)
    for (const double off : {-1e-9, 2.0, 1e300, -1e300, kNaN}) {
      Point point = lower_ + size_ / 2;
      point[axis] = lower_[axis] + off;
      EXPECT_EQ(map.winding(point), ColourMap::kUnknown) << axis << " " << off;
    }
  EXPECT_EQ(ColourMap().winding(lower_ + size_ / 2), ColourMap::kUnknown);
}

TEST_F(ColourMapTest, KnowsNothingOfABoxThatDoesNotFitTheRoot) {
  MaskPages pages(random_mask(10), 4096, 3);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double side : {2.1, -0.1, 8589934591.0, 1e300, kInfinity, kInfinity - kInfinity}) {
    ColourMap map;
    memory_.resize(ColourMap::bytes(kMany));
    map.fill(pages.mask(lower_), tree_of(lower_, {side, 1, 1}), kMany, pages.reader(), memory_);
    EXPECT_EQ(map.winding(lower_ + size_ / 2), ColourMap::kUnknown) << side;
  }
  EXPECT_TRUE(pages.take_asked().empty());
}

TEST_F(ColourMapTest, TakesNoMoreThanItsMemory) {
  EXPECT_EQ(ColourMap::bytes(1), 16u);
  EXPECT_EQ(ColourMap::bytes(4003), 1000u);
  EXPECT_EQ(ColourMap::bytes(~std::uint64_t{0}), 65536u);
}

}  // namespace
}  // namespace planetree::octree
