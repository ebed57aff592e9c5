#include "octree/builder/tree/area_split.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "octree/builder/tree/float_rounding.h"
#include "octree/page/frame.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

std::vector<SplitItem> boxes_around(const std::vector<Vec3>& centres, float half = 0.01f) {
  std::vector<SplitItem> items;
  for (const Vec3& at : centres) {
    const auto x = static_cast<float>(at.x), y = static_cast<float>(at.y),
               z = static_cast<float>(at.z);
    items.push_back({{0, static_cast<std::uint32_t>(items.size())},
                     {{x - half, y - half, z - half}, {x + half, y + half, z + half}}});
  }
  return items;
}

// Reorders the items by one split and returns the size of the first part.
std::uint32_t split_by_area(std::vector<SplitItem>& items) {
  AreaSplitter splitter(items);
  const std::uint32_t left = splitter.split(0, static_cast<std::uint32_t>(items.size()));
  std::vector<SplitItem> split;
  for (std::uint32_t i = 0; i < items.size(); ++i) split.push_back(splitter.in_split_order(i));
  items = split;
  return left;
}

std::vector<std::uint32_t> positions(const std::vector<SplitItem>& items) {
  std::vector<std::uint32_t> all;
  for (const SplitItem& item : items) all.push_back(item.key.position);
  return all;
}

TEST(AreaSplit, SeparatesTwoClustersAlongAnyAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    Noise noise(static_cast<std::uint64_t>(axis));
    std::vector<Vec3> centres;
    for (int i = 0; i < 48; ++i) {
      Vec3 at = noise.point(0, 0.1);
      (axis == 0 ? at.x : axis == 1 ? at.y : at.z) += i % 3 == 0 ? 5 : 0;
      centres.push_back(at);
    }
    std::vector<SplitItem> items = boxes_around(centres);
    EXPECT_EQ(split_by_area(items), 32u);
    for (std::size_t i = 0; i < items.size(); ++i)
      EXPECT_EQ(items[i].key.position % 3 == 0, i >= 32) << i;
  }
}

TEST(AreaSplit, KeepsEveryItemAndBothSides) {
  Noise noise(7);
  for (std::size_t count = kMaxBlockTriangles + 1; count <= kMaxAreaSplit; ++count) {
    std::vector<Vec3> centres;
    for (std::size_t i = 0; i < count; ++i) centres.push_back(noise.point(-1, 1));
    std::vector<SplitItem> items = boxes_around(centres);
    const std::uint32_t left = split_by_area(items);
    EXPECT_GE(left, 1u);
    EXPECT_LT(left, count);
    const std::vector<std::uint32_t> all = positions(items);
    EXPECT_EQ(std::set<std::uint32_t>(all.begin(), all.end()).size(), count);
  }
}

TEST(AreaSplit, OrdersEqualBoxesByPosition) {
  std::vector<SplitItem> items = boxes_around(std::vector<Vec3>(40, Vec3{0.5, 0.5, 0.5}));
  std::vector<SplitItem> turned(items.rbegin(), items.rend());
  const std::uint32_t left = split_by_area(items);
  EXPECT_EQ(split_by_area(turned), left);
  EXPECT_EQ(positions(turned), positions(items));
  EXPECT_TRUE(std::ranges::is_sorted(positions(items)));
}

TEST(AreaSplit, HalvesCoincidentBoxesInWholeBlocks) {
  for (const std::size_t count : {32u, 64u, 512u}) {
    std::vector<SplitItem> items = boxes_around(std::vector<Vec3>(count, Vec3{0.5, 0.5, 0.5}));
    EXPECT_EQ(split_by_area(items), count / 2);
  }
}

TEST(AreaSplit, HalvesBoxesOfInfiniteCost) {
  for (const std::size_t count : {17u, 33u, 100u, 128u}) {
    std::vector<SplitItem> items = boxes_around(std::vector<Vec3>(count));
    for (SplitItem& item : items) item.box.upper.fill(std::numeric_limits<float>::infinity());
    const std::uint32_t left = split_by_area(items);
    EXPECT_EQ(left % kMaxBlockTriangles, 0u);
    EXPECT_GE(left, 1u);
    EXPECT_LT(left, count);
  }
}

}  // namespace
}  // namespace planetree::octree
