#include "query/shell/sphere_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/query/shell/shells.h"

namespace planetree::query {
namespace {

using Node = SphereTree::Node;

void expect_sound(const SphereTree& tree, const std::vector<ShellPoint>& points) {
  ASSERT_EQ(tree.points().size(), points.size());
  std::vector<int> seen(points.size());
  for (const SphereTree::Point& point : tree.points()) ++seen[point.number];
  for (const int count : seen) EXPECT_EQ(count, 1);
  std::size_t in_leaves = 0;
  for (const Node& node : tree.nodes()) {
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Vec3& p = tree.points()[i].position;
      const long double x = p.x - static_cast<long double>(node.centre.x),
                        y = p.y - static_cast<long double>(node.centre.y),
                        z = p.z - static_cast<long double>(node.centre.z);
      EXPECT_LE(std::sqrt(x * x + y * y + z * z), node.radius);
    }
    if (node.children == 0) {
      EXPECT_LE(node.count, SphereTree::kMaxLeafPoints);
      EXPECT_LE(node.radius, tree.leaf_radius());
      in_leaves += node.count;
      continue;
    }
    std::uint32_t next = node.first;
    for (std::uint32_t i = node.first_child; i < node.first_child + node.children; ++i) {
      EXPECT_GT(i, &node - tree.nodes().data());
      EXPECT_EQ(tree.nodes()[i].first, next);
      next += tree.nodes()[i].count;
    }
    EXPECT_EQ(next, node.first + node.count);
  }
  EXPECT_EQ(in_leaves, points.size());
}

TEST(SphereTree, ContainsAllPointsInEveryLevel) {
  for (const std::size_t count : {1, 2, 6, 7, 8, 25, 1000, 4097})
    expect_sound(SphereTree(ball_shell(count, 0.7)), ball_shell(count, 0.7));
}

TEST(SphereTree, DividesPointsThatAreEqual) {
  const std::vector<ShellPoint> points(100, ShellPoint{{1, 2, 3}, {0, 1, 0}});
  const SphereTree tree(points);
  expect_sound(tree, points);
  EXPECT_LT(tree.leaf_radius(), 1e-100);
}

TEST(SphereTree, LevelsGoFromCoarseToFine) {
  const SphereTree tree(ball_shell(1000, 1));
  EXPECT_EQ(tree.nodes()[0].count, 1000u);
  EXPECT_EQ(tree.nodes()[1].count, 250u);
  // A quarter of a sphere has a half of a great circle.
  EXPECT_LT(tree.nodes()[1].radius, 1.05);
  EXPECT_LT(tree.leaf_radius(), 0.2);
  EXPECT_GE(tree.reach(), 1);
}

TEST(SphereTree, DividesNormalsByTheirLength) {
  const double length = 1 + 0x1p-22;
  const SphereTree tree(std::vector<ShellPoint>{{{}, {0, 0, length}}});
  EXPECT_EQ(tree.points()[0].normal.z, 1);
  EXPECT_GE(tree.normal_error(), length - 1);
}

}  // namespace
}  // namespace planetree::query
