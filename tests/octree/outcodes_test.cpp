#include "octree/outcodes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/octree/sample_tree.h"

namespace planetree::octree {
namespace {

// Calls check(block) for every block of a model.
template <class Check>
void each_block(const Soup& soup, const Check& check) {
  const SampleTree sample = build_sample(soup);
  const SamplePages pages(sample);
  for (std::uint32_t page = 0; page < pages.size(); ++page) {
    const SampleFrame& frame = pages.frame(page);
    const FrameHeader& header = frame.header();
    const auto* starts = reinterpret_cast<const std::uint64_t*>(frame.data() + kSlotBytes);
    for (std::uint32_t slot = header.first_block_slot; slot < 4096 / kSlotBytes; ++slot)
      if ((starts[slot / 64] >> slot % 64 & 1) != 0)
        check(BlockView(frame.data() + slot * kSlotBytes, sample.shape));
  }
}

bool boxes_apart(const Triangle& t, const Point& lower, const Point& upper) {
  const Point least = t[0].cwiseMin(t[1]).cwiseMin(t[2]);
  const Point most = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
  return (most.array() < lower.array()).any() || (least.array() > upper.array()).any();
}

void expect_true_codes(const Soup& soup) {
  Noise noise(5);
  std::size_t apart = 0;
  each_block(soup, [&](const BlockView& block) {
    for (int i = 0; i < 20; ++i) {
      const Vec3 at = noise.point(-0.6, 0.6), size = noise.point(0, 0.3);
      const Point lower(at.x, at.y, at.z), upper = lower + Point(size.x, size.y, size.z);
      const unsigned meeting = Outcodes(lower, upper).meeting(block);
      EXPECT_EQ(meeting >> block.triangle_count(), 0u);
      for (unsigned k = 0; k < block.triangle_count(); ++k) {
        const bool expected = boxes_apart(block.triangle(k), lower, upper);
        EXPECT_EQ((meeting >> k & 1) == 0, expected);
        apart += expected ? 1 : 0;
      }
    }
  });
  EXPECT_GT(apart, 0u);
}

TEST(Outcodes, TellTrianglesApartFromBoxes) {
  expect_true_codes(sphere(4));              // float32
  expect_true_codes(scattered(2000, 0.05));  // float64
}

// The box of one vertex, and of a point as near to it as double can name.
TEST(Outcodes, TellWhichTrianglesHaveAVertex) {
  for (const Soup& soup : {sphere(4), scattered(500, 0.05)})
    each_block(soup, [&](const BlockView& block) {
      const Point vertex = block.vertex(block.header().corner[1][0]);
      const unsigned within = Outcodes(vertex, vertex).with_corner_within(block);
      EXPECT_EQ(within >> block.triangle_count(), 0u);
      for (unsigned i = 0; i < block.triangle_count(); ++i) {
        const Triangle triangle = block.triangle(i);
        EXPECT_EQ((within >> i & 1) != 0,
                  std::find(triangle.begin(), triangle.end(), vertex) != triangle.end());
      }
    });
}

// Coordinates between floats are rounded away from the box, never into it.
TEST(Outcodes, LeaveNothingOutThatIsInTheBox) {
  each_block(sphere(4), [&](const BlockView& block) {
    for (unsigned i = 0; i < block.triangle_count(); ++i) {
      const Point vertex = block.triangle(i)[0];
      const Point nudge = Point::Constant(1e-12);
      const Outcodes about(vertex - nudge, vertex + nudge);
      EXPECT_NE(about.with_corner_within(block) >> i & 1, 0u);
      EXPECT_NE(about.meeting(block) >> i & 1, 0u);
    }
  });
}

}  // namespace
}  // namespace planetree::octree
