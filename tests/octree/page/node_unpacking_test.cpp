#include "octree/page/node_unpacking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "octree/page/frame.h"
#include "tests/octree/support/each_target.h"

namespace planetree::octree {
namespace {

void put(PackedDiscs::Words& words, std::size_t child, std::uint16_t word) {
  words.low[child] = static_cast<std::uint8_t>(word);
  words.high[child] = static_cast<std::uint8_t>(word >> 8);
}

// Puts one child into `node`, and its disc streams into `discs`.
void put(Node& node, PackedDiscs& discs, std::size_t child, const PackedChild& packed) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    node.lower[axis][child] = packed.lower[axis];
    node.upper[axis][child] = packed.upper[axis];
  }
  put(discs.u, child, static_cast<std::uint16_t>(packed.normal.u));
  put(discs.v, child, static_cast<std::uint16_t>(packed.normal.v));
  put(discs.slab_lower, child, static_cast<std::uint16_t>(packed.slab_lower));
  put(discs.slab_upper, child, static_cast<std::uint16_t>(packed.slab_upper));
  put(discs.radius, child, packed.radius);
}

Node node_of(const FloatBox& box) {
  Node node{};
  node.box = box;
  for (std::size_t axis = 0; axis < 3; ++axis)
    node.step[axis] = box_step(box.lower[axis], box.upper[axis]);
  return node;
}

class UnpackDiscs : public testing::Test {
 protected:
  // A random word, often at an end of its range.
  std::uint16_t word() {
    constexpr std::uint16_t kEnds[] = {0, 1, 0x7fff, 0x8000, 0x8001, 0xffff};
    return random_() % 3 == 0 ? kEnds[random_() % std::size(kEnds)]
                              : static_cast<std::uint16_t>(random_());
  }

  PackedChild child() {
    PackedChild packed;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::uint8_t>(random_() % 4 == 0 ? 0 : random_());
      const auto b = static_cast<std::uint8_t>(random_() % 4 == 0 ? 255 : random_());
      packed.lower[axis] = std::min(a, b);
      packed.upper[axis] = static_cast<std::uint8_t>(kBoxSteps - std::max(a, b));
    }
    packed.normal = {static_cast<std::int16_t>(word()), static_cast<std::int16_t>(word())};
    const auto a = static_cast<std::int16_t>(word()), b = static_cast<std::int16_t>(word());
    packed.slab_lower = std::min(a, b);
    packed.slab_upper = std::max(a, b);
    packed.radius = word();
    return packed;
  }

  FloatBox box() {
    FloatBox box;
    const float size = std::ldexp(1.0f, static_cast<int>(random_() % 60) - 30);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.lower[axis] = size * (static_cast<float>(random_() % 2001) - 1000) / 300;
      const bool flat = random_() % 8 == 0;
      box.upper[axis] = box.lower[axis] + (flat ? 0 : size * static_cast<float>(random_() % 100));
    }
    return box;
  }

  std::mt19937_64 random_{1};
};

// Compares bit for bit with children unpacked one by one, on every instruction set.
TEST_F(UnpackDiscs, MatchesUnpackingOneByOneBitForBit) {
  for (int round = 0; round < 2000; ++round) {
    const unsigned count = 1 + static_cast<unsigned>(random_() % kFanOut);
    const FloatBox parent = box();
    const Node start = node_of(parent);
    Node expected = start, packed_node = start;
    PackedDiscs discs;
    for (unsigned i = 0; i < kFanOut; ++i) {
      const bool there = i < count;
      const PackedChild packed = there ? child() : PackedChild{};
      if (there) put(packed_node, discs, i, packed);
      const FloatBox own = unpack_box(parent, packed);
      EXPECT_EQ(child_box(packed_node, i).lower, own.lower);
      EXPECT_EQ(child_box(packed_node, i).upper, own.upper);
      const Disc disc = there ? unpack_disc(own, packed) : Disc{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        expected.lower[axis][i] = packed.lower[axis];
        expected.upper[axis][i] = packed.upper[axis];
        expected.normal[axis][i] = disc.normal[axis];
      }
      expected.slab_lower[i] = disc.slab_lower;
      expected.slab_upper[i] = disc.slab_upper;
      expected.radius[i] = disc.radius;
    }
    for (const Node& node : on_each_target([&] {
           Node unpacked = packed_node;
           const ChildFaults faults = unpack_discs(discs, count, unpacked);
           EXPECT_FALSE(faults.inverted_box || faults.inverted_slab);
           return unpacked;
         }))
      ASSERT_EQ(std::memcmp(&node, &expected, sizeof node), 0) << round;
  }
}

TEST_F(UnpackDiscs, ReportsCrossedBoundsOfAnyChild) {
  for (unsigned inverted_slab = 0; inverted_slab < kFanOut; ++inverted_slab)
    for (int what = 0; what < 4; ++what) {
      Node packed_node = node_of(box());
      PackedDiscs discs;
      for (unsigned i = 0; i < kFanOut; ++i) {
        PackedChild packed = child();
        const bool this_one = i == inverted_slab;
        if (what < 3 && this_one) packed.lower[what] = 8, packed.upper[what] = kBoxSteps - 7;
        if (what == 3 && this_one) packed.slab_lower = -3, packed.slab_upper = -4;
        put(packed_node, discs, i, packed);
      }
      for (const ChildFaults& faults : on_each_target([&] {
             Node node = packed_node;
             return unpack_discs(discs, kFanOut, node);
           })) {
        ASSERT_EQ(faults.inverted_box, what < 3);
        ASSERT_EQ(faults.inverted_slab, what == 3);
      }
    }
}

}  // namespace
}  // namespace planetree::octree
