#include "octree/traversal/nearby_lists.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <new>

namespace planetree::octree {
namespace {

// Adds a subtree whose box spans x to x + 1 on each axis.
void add(NearbySubtrees& list, float x, std::uint32_t link) {
  for (unsigned axis = 0; axis < 3; ++axis) {
    *list.next_lower(axis) = x;
    *list.next_upper(axis) = x + 1;
  }
  *list.next_link() = link;
  list.add(1);
}

constexpr LinkFormat kLinks(65536, LinkTarget::kSlot);
constexpr std::uint32_t kToBlock = kLinks.make(true, 1, 40), kToNode = kLinks.make(false, 2, 50);

TEST(NearbySubtrees, KeepsBoxesAndLinks) {
  NearbySubtrees list;
  list.clear();
  add(list, 2, kToBlock);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list.link(0), kToBlock);
  for (unsigned axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(list.lower(axis)[0], 2);
    EXPECT_EQ(list.upper(axis)[0], 3);
  }
}

TEST(NearbySubtrees, PadsToAWholeVectorWithoutNaN) {
  // Memory with other contents before: NaN in every float.
  alignas(NearbySubtrees) unsigned char memory[sizeof(NearbySubtrees)];
  std::memset(memory, 0xff, sizeof memory);
  auto& list = *new (memory) NearbySubtrees;
  add(list, 2, kToBlock);
  for (std::size_t i = 1; i < 16; ++i)
    for (unsigned axis = 0; axis < 3; ++axis) {
      EXPECT_FALSE(std::isnan(list.lower(axis)[i])) << i;
      EXPECT_FALSE(std::isnan(list.upper(axis)[i])) << i;
    }
}

TEST(NearbySubtrees, HasCapacityForANodesChildren) {
  NearbySubtrees list;
  while (list.has_capacity()) add(list, 0, kToBlock);
  EXPECT_LT(NearbySubtrees::kMax - kFanOut, list.size());
  EXPECT_LE(list.size(), NearbySubtrees::kMax);
}

TEST(NearbySubtrees, RemoveMovesTheLastEntry) {
  NearbySubtrees list;
  for (std::uint32_t i = 0; i < 3; ++i) add(list, static_cast<float>(10 * i), kToBlock + i);
  list.remove(0);
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list.link(0), kToBlock + 2);
  EXPECT_EQ(list.lower(1)[0], 20);
  EXPECT_EQ(list.link(1), kToBlock + 1);
  list.remove(1);
  EXPECT_EQ(list.size(), 1u);
  EXPECT_EQ(list.link(0), kToBlock + 2);
}

TEST(NearbySubtrees, ReportsWhetherAllAreBlocks) {
  NearbySubtrees list;
  add(list, 0, kToBlock);
  EXPECT_TRUE(list.are_blocks());
  add(list, 0, kToNode);
  EXPECT_FALSE(list.are_blocks());
  list.clear();
  EXPECT_EQ(list.size(), 0u);
}

TEST(NearbySubtrees, FarthestIsAnUpperBound) {
  NearbySubtrees list;
  add(list, 1, kToBlock);
  const double farthest = list.farthest(0, Point(0, 0, 2));
  EXPECT_GE(farthest, 3);
  EXPECT_LE(farthest, 3.0001);
}

}  // namespace
}  // namespace planetree::octree
