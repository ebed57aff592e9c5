#include "octree/traversal/frontier.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace planetree::octree {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
using Order = Frontier::Order;

// Pushes children with the given bounds, ascending. Their links encode group and index.
void push(Frontier& frontier, std::uint32_t group, const std::vector<float>& bounds,
          unsigned first = 0) {
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    frontier.next().bound_bits[i] = std::bit_cast<std::int32_t>(bounds[i]);
    frontier.next().link[i] = group * kFanOut + static_cast<std::uint32_t>(i);
  }
  frontier.push(first, static_cast<unsigned>(bounds.size()), group);
}

std::vector<float> drain(Frontier& frontier, Order order, float threshold, float& dropped) {
  std::vector<float> bounds;
  FrontierEntry entry;
  while (frontier.pop(order, threshold, entry, dropped)) bounds.push_back(entry.bound);
  return bounds;
}

TEST(FrontierTest, PopsNearestFirstOverAllGroups) {
  Frontier frontier;
  push(frontier, 0, {1, 5, 9});
  push(frontier, 1, {2, 3});
  push(frontier, 2, {4, 4, 8});
  float dropped = kInfinity;
  EXPECT_EQ(drain(frontier, Order::kNearest, 100, dropped),
            (std::vector<float>{1, 2, 3, 4, 4, 5, 8, 9}));
  EXPECT_EQ(dropped, kInfinity);
}

TEST(FrontierTest, PopsEqualBoundsLastPushedFirst) {
  Frontier frontier;
  for (std::uint32_t group = 0; group < 3; ++group) push(frontier, group, {0});
  FrontierEntry entry;
  float dropped = kInfinity;
  for (std::uint32_t group = 3; group-- > 0;) {
    ASSERT_TRUE(frontier.pop(Order::kNearest, 1, entry, dropped));
    EXPECT_EQ(entry.link, group * kFanOut);
    EXPECT_EQ(entry.from, group);
  }
}

TEST(FrontierTest, PopsLastGroupFirst) {
  Frontier frontier;
  push(frontier, 0, {1, 5});
  push(frontier, 1, {2, 3});
  float dropped = kInfinity;
  EXPECT_EQ(drain(frontier, Order::kLast, 100, dropped), (std::vector<float>{2, 3, 1, 5}));
}

TEST(FrontierTest, SkipsEntriesBeforeFirst) {
  for (const Order order : {Order::kNearest, Order::kLast}) {
    Frontier frontier;
    push(frontier, 0, {1, 4, 5}, 1);
    push(frontier, 1, {2}, 1);
    float dropped = kInfinity;
    EXPECT_EQ(drain(frontier, order, 100, dropped), (std::vector<float>{4, 5}));
  }
}

TEST(FrontierTest, ReportsTheLeastDroppedBound) {
  for (const Order order : {Order::kNearest, Order::kLast}) {
    Frontier frontier;
    push(frontier, 0, {1, 7, 8});
    push(frontier, 1, {2, 6});
    float dropped = kInfinity;
    EXPECT_EQ(drain(frontier, order, 5, dropped).size(), 2u);
    EXPECT_EQ(dropped, 6);
    FrontierEntry entry;
    EXPECT_FALSE(frontier.pop(order, 100, entry, dropped));
  }
}

// Two full-height paths of groups fit, and no entry is lost.
TEST(FrontierTest, PopsDepthFirstWithManyGroups) {
  Frontier frontier;
  std::size_t pushed = 0, taken = 0;
  FrontierEntry entry;
  float dropped = kInfinity;
  for (std::uint32_t level = 0; level < Frontier::kMaxToOrder + 2 * kMaxHeight; ++level) {
    ASSERT_TRUE(frontier.has_capacity());
    EXPECT_EQ(frontier.is_ordered(), level <= Frontier::kMaxToOrder);
    push(frontier, level, {1, 2, 3});
    pushed += 3;
    ASSERT_TRUE(frontier.pop(Order::kNearest, 100, entry, dropped));
    ++taken;
    if (level >= Frontier::kMaxToOrder) {
      EXPECT_EQ(entry.link / kFanOut, level);
    }
  }
  EXPECT_EQ(taken + drain(frontier, Order::kNearest, 100, dropped).size(), pushed);
}

}  // namespace
}  // namespace planetree::octree
