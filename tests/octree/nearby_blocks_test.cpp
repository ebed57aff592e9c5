#include "octree/nearby_blocks.h"

#include <gtest/gtest.h>

#include <limits>

namespace planetree::octree {
namespace {

// One child, between x and x + 1 of each axis.
Node parent_of(float x, std::uint32_t link) {
  Node node{};
  for (unsigned axis = 0; axis < 3; ++axis) {
    node.lower[axis][3] = x;
    node.upper[axis][3] = x + 1;
  }
  node.link[3] = link;
  return node;
}

TEST(NearbyBlocks, KeepsBoxesAndLinks) {
  NearbyBlocks list;
  list.begin();
  ASSERT_TRUE(list.add(parent_of(2, 77), 3));
  list.finish();
  EXPECT_TRUE(list.complete());
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list.link(0), 77u);
  for (unsigned axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(list.lower(axis)[0], 2);
    EXPECT_EQ(list.upper(axis)[0], 3);
  }
}

TEST(NearbyBlocks, EndsWithBoxesThatNothingIsNear) {
  NearbyBlocks list;
  list.begin();
  ASSERT_TRUE(list.add(parent_of(2, 77), 3));
  list.finish();
  for (std::size_t i = 1; i < kFanOut; ++i)
    EXPECT_EQ(list.lower(0)[i], std::numeric_limits<float>::infinity()) << i;
}

TEST(NearbyBlocks, HasRoomForSoManyAndNoMore) {
  NearbyBlocks list;
  list.begin();
  for (std::uint32_t i = 0; i < NearbyBlocks::kMost; ++i) EXPECT_TRUE(list.add(parent_of(0, i), 3));
  EXPECT_FALSE(list.add(parent_of(0, 99), 3));
  EXPECT_EQ(list.size(), NearbyBlocks::kMost);
}

TEST(NearbyBlocks, IsNoListBeforeItIsFinishedNorOfNothing) {
  NearbyBlocks list;
  EXPECT_FALSE(list.complete());
  list.begin();
  list.finish();
  EXPECT_FALSE(list.complete());
  ASSERT_TRUE(list.add(parent_of(1, 0), 3));
  EXPECT_FALSE(list.complete());
  list.finish();
  EXPECT_TRUE(list.complete());
  list.begin();
  EXPECT_FALSE(list.complete());
}

}  // namespace
}  // namespace planetree::octree
