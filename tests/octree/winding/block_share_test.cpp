#include "octree/winding/block_share.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "octree/geometry/angles.h"
#include "octree/traversal/tree_walk.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

class BlockShareTest : public testing::Test {
 protected:
  // Calls call(block) for each block of a tree of a soup.
  template <class Call>
  static void each_block(const Soup& soup, const Call& call) {
    const SampleTree sample = build_sample(soup, 4096, 0, true);
    SamplePages pages(sample);
    const TreeInfo info = tree_info(sample);
    TraversalStats work;
    const auto visit = [&](const BlockView& block, std::uint32_t) { call(block); };
    EXPECT_TRUE(BoxWalk(info, info.box_lower, info.box_upper, pages.reader(), work)
                    .run(info.record_count, visit));
  }
  // Checks the sum, with the shares that it leaves out, against single shares.
  static BlockShare expect_right(const BlockView& block, const Point& point) {
    const BlockShare found = block_share(point, block);
    double truth = 0, error = 0;
    for (unsigned i = 0; i < block.triangle_count(); ++i) {
      if ((found.unsure >> i & 1) != 0) continue;
      const WindingShare share = winding_share(point, block.triangle(i));
      truth += share.value;
      error += share.error;
    }
    EXPECT_LE(std::fabs(found.value - truth), found.error + error);
    EXPECT_LT(found.error, 1e-6);
    return found;
  }
  static Point random_point(Noise& noise, double low, double high) {
    const Vec3 point = noise.point(low, high);
    return {point.x, point.y, point.z};
  }
};

TEST_F(BlockShareTest, IsTheSumOfTheSharesOfItsTriangles) {
  Noise noise(1);
  int blocks = 0, left_out = 0, triangles = 0;
  for (const Soup& soup : {scattered(300, 0.3), sphere(3), height_field(12), repeated(40)})
    each_block(soup, [&](const BlockView& block) {
      ++blocks;
      for (int i = 0; i < 40; ++i) {
        const BlockShare found = expect_right(block, random_point(noise, -1.5, 1.5));
        left_out += std::popcount(found.unsure);
        triangles += static_cast<int>(block.triangle_count());
      }
    });
  EXPECT_GT(blocks, 60);
  EXPECT_LT(left_out, triangles / 20);
}

// Sixteen shares of nearly 1/8 sum to nearly 2: the product turns about more than once.
TEST_F(BlockShareTest, CountsWholeTurns) {
  Soup soup;
  const Vec3 a{1, 0, 0}, b{0, 1, 0}, c{0, 0, 1};
  for (int i = 0; i < 16; ++i) soup.push_back({a, b, c});
  each_block(soup, [&](const BlockView& block) {
    const Triangle triangle = block.triangle(0);
    const Point middle = (triangle[0] + triangle[1] + triangle[2]) / 3;
    const Point normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
    double greatest = 0;
    for (double height = 0.01; height < 2; height *= 1.1)
      for (const double side : {-1.0, 1.0}) {
        const BlockShare found = expect_right(block, middle + side * height * normal);
        if (found.unsure == 0) greatest = std::max(greatest, std::fabs(found.value));
      }
    EXPECT_GT(greatest, block.triangle_count() * 0.1);
  });
}

TEST_F(BlockShareTest, LeavesOutTrianglesThatThePointIsOnOrInAPlaneWith) {
  each_block({{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}}, [](const BlockView& block) {
    const Triangle triangle = block.triangle(0);
    EXPECT_EQ(block_share(triangle[0], block).unsure, 1u);
    EXPECT_EQ(block_share((triangle[0] + triangle[1]) / 2, block).unsure, 1u);
    EXPECT_EQ(block_share((triangle[0] + triangle[1] + triangle[2]) / 3, block).unsure, 1u);
    EXPECT_EQ(block_share(triangle[0] + 3 * (triangle[1] - triangle[0]), block).unsure, 1u);
  });
}

}  // namespace
}  // namespace planetree::octree
