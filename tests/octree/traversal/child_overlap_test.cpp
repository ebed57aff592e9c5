#include "octree/traversal/overlap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "octree/page/frame.h"
#include "octree/traversal/nearby_lists.h"
#include "tests/octree/support/each_target.h"

namespace planetree::octree {
namespace {

// Appends child `child` of `node` to `list`.
void list_child(const Node& node, unsigned child, NearbySubtrees& list) {
  const FloatBox box = child_box(node, child);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    *list.next_lower(axis) = box.lower[axis];
    *list.next_upper(axis) = box.upper[axis];
  }
  *list.next_link() = node.link[child];
  list.add(1);
}

void expect_child(const NearbySubtrees& list, std::size_t at, const Node& node, unsigned child) {
  const FloatBox box = child_box(node, child);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(list.lower(axis)[at], box.lower[axis]);
    EXPECT_EQ(list.upper(axis)[at], box.upper[axis]);
  }
  EXPECT_EQ(list.link(at), node.link[child]);
}

class ChildOverlapTest : public testing::Test {
 protected:
  float coordinate() { return static_cast<float>(static_cast<int>(random_() % 2001) - 1000) / 700; }

  Node node() {
    Node node{};
    node.child_count = static_cast<std::uint8_t>(1 + random_() % kFanOut);
    for (unsigned i = 0; i < node.child_count; ++i)
      node.link[i] = static_cast<std::uint32_t>(random_());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float a = coordinate(), b = coordinate();
      node.box.lower[axis] = std::min(a, b);
      node.box.upper[axis] = std::max(a, b);
      node.step[axis] = box_step(node.box.lower[axis], node.box.upper[axis]);
      for (unsigned i = 0; i < node.child_count; ++i) {
        node.lower[axis][i] = static_cast<std::uint8_t>(random_() % (kBoxSteps + 1));
        node.upper[axis][i] =
            static_cast<std::uint8_t>(random_() % (kBoxSteps + 1u - node.lower[axis][i]));
      }
    }
    return node;
  }

  std::mt19937 random_{1};
};

bool meet(const FloatBox& a, const FloatBox& b) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (a.lower[axis] > b.upper[axis] || a.upper[axis] < b.lower[axis]) return false;
  return true;
}

float next(float value, float towards) { return std::nextafter(value, towards); }

// Compared with boxes that begin exactly at a child's end, or one ulp beyond.
TEST_F(ChildOverlapTest, ChildrenMeetingMatchesScalarTest) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (int round = 0; round < 500; ++round) {
    const Node at = node();
    const FloatBox child = child_box(at, random_() % at.child_count);
    FloatBox other{{-9, -9, -9}, {9, 9, 9}};
    const std::size_t axis = random_() % 3;
    switch (random_() % 4) {
      case 0:
        other.upper[axis] = child.lower[axis];
        break;
      case 1:
        other.upper[axis] = next(child.lower[axis], -kInfinity);
        break;
      case 2:
        other.lower[axis] = child.upper[axis];
        break;
      default:
        other.lower[axis] = next(child.upper[axis], kInfinity);
        break;
    }
    unsigned expected = 0;
    for (unsigned i = 0; i < at.child_count; ++i)
      expected |= unsigned{meet(child_box(at, i), other)} << i;
    for (const unsigned met : on_each_target([&] { return children_meeting(at, other); }))
      ASSERT_EQ(met, expected) << round;
  }
}

// Lists of random length, compared with boxes as above.
TEST_F(ChildOverlapTest, SubtreesMeetingMatchesScalarTest) {
  for (int round = 0; round < 300; ++round) {
    NearbySubtrees list;
    const std::size_t most = 1 + random_() % NearbySubtrees::kMax;
    while (list.size() < most) {
      const Node at = node();
      list_child(at, static_cast<unsigned>(random_() % at.child_count), list);
    }
    const auto box_of = [&](std::size_t i) {
      FloatBox box;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] = list.lower(axis)[i];
        box.upper[axis] = list.upper(axis)[i];
      }
      return box;
    };
    FloatBox other = box_of(random_() % most);
    const std::size_t axis = random_() % 3;
    other.lower[axis] = other.upper[axis];
    if (random_() % 2 == 0) other.lower[axis] = other.upper[axis] = next(other.upper[axis], 9);
    std::uint64_t expected = 0;
    for (std::size_t i = 0; i < most; ++i) expected |= std::uint64_t{meet(box_of(i), other)} << i;
    for (const std::uint64_t met : on_each_target([&] { return subtrees_meeting(list, other); }))
      ASSERT_EQ(met, expected) << round;
  }
}

// Thresholds equal to a child's squared distance, or one ulp below.
TEST_F(ChildOverlapTest, AddChildrenWithinMatchesScalarTest) {
  for (int round = 0; round < 500; ++round) {
    const Node at = node();
    FloatQuery query;
    query.x = coordinate(), query.y = coordinate(), query.z = coordinate();
    const std::array<float, 3> p{query.x, query.y, query.z};
    const auto squared = [&](unsigned i) {
      const FloatBox box = child_box(at, i);
      std::array<float, 3> gap;
      for (std::size_t axis = 0; axis < 3; ++axis)
        gap[axis] = std::max({box.lower[axis] - p[axis], p[axis] - box.upper[axis], 0.0f});
      return gap[0] * gap[0] + gap[1] * gap[1] + gap[2] * gap[2];
    };
    float threshold = squared(static_cast<unsigned>(random_() % at.child_count));
    if (random_() % 2 == 0) threshold = next(threshold, 0);
    std::vector<unsigned> expected;
    for (unsigned i = 0; i < at.child_count; ++i)
      if (squared(i) <= threshold) expected.push_back(i);
    // Appends to a list of random length that has capacity for a node's children.
    NearbySubtrees before;
    const std::size_t others = random_() % (NearbySubtrees::kMax - kFanOut + 1);
    while (before.size() < others) list_child(at, 0, before);
    for (const NearbySubtrees& list : on_each_target([&] {
           NearbySubtrees list = before;
           add_children_within(at, query, threshold, list);
           return list;
         })) {
      ASSERT_EQ(list.size(), others + expected.size()) << round;
      for (std::size_t i = 0; i < others; ++i) expect_child(list, i, at, 0);
      for (std::size_t i = 0; i < expected.size(); ++i)
        expect_child(list, others + i, at, expected[i]);
    }
  }
}

}  // namespace
}  // namespace planetree::octree
