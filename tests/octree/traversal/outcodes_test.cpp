#include "octree/traversal/overlap.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/octree/support/each_block.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

// Calls check(block) for every block of a model.
template <class Check>
void each_block_of(const Soup& soup, const Check& check) {
  const SampleTree sample = build_sample(soup);
  each_block(sample, SamplePages(sample),
             [&](const BlockView& block, std::uint32_t) { check(block); });
}

// The box is a single vertex of the block.
TEST(Outcodes, FindTrianglesWithAVertex) {
  for (const Soup& soup : {sphere(4), scattered(500, 0.05)})
    each_block_of(soup, [&](const BlockView& block) {
      const Point vertex = block.vertex(block.header().corners(0)[1]);
      const unsigned within = Outcodes(vertex, vertex).with_corner_within(block);
      EXPECT_EQ(within >> block.triangle_count(), 0u);
      for (unsigned i = 0; i < block.triangle_count(); ++i) {
        const Triangle triangle = block.triangle(i);
        EXPECT_EQ((within >> i & 1) != 0,
                  std::find(triangle.begin(), triangle.end(), vertex) != triangle.end());
      }
    });
}

// Coordinates are rounded away from the box, never into it.
TEST(Outcodes, MissNoVertexInTheBox) {
  each_block_of(sphere(4), [&](const BlockView& block) {
    for (unsigned i = 0; i < block.triangle_count(); ++i) {
      const Point vertex = block.triangle(i)[0];
      const Point nudge = Point::Constant(1e-12);
      const Outcodes about(vertex - nudge, vertex + nudge);
      EXPECT_NE(about.with_corner_within(block) >> i & 1, 0u);
    }
  });
}

}  // namespace
}  // namespace planetree::octree
