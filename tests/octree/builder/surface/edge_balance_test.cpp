#include "octree/builder/surface/edge_balance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include <tbb/global_control.h>

#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

EdgeBalance balance(const Soup& soup, std::uint64_t first_index = 0) {
  return balance_of(store(soup, first_index));
}

Soup tetrahedron() {
  const Vec3 a{0, 0, 0}, b{0, 1, 0}, c{1, 0, 0}, d{0, 0, 1};
  return {{a, b, c}, {a, d, b}, {b, d, c}, {c, d, a}};
}

Soup both(Soup left, const Soup& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

TEST(EdgeBalance, ClosedSurfacesHaveNoUnbalancedEdges) {
  EXPECT_EQ(balance(tetrahedron()).unbalanced_edges, 0u);
  EXPECT_EQ(balance(sphere(5)).unbalanced_edges, 0u);
  EXPECT_EQ(balance(both(tetrahedron(), tetrahedron())).unbalanced_edges, 0u);
  EXPECT_EQ(balance(both(tetrahedron(), sphere(2))).unbalanced_edges, 0u);
}

TEST(EdgeBalance, IgnoresFacesWithoutArea) {
  Soup soup = tetrahedron();
  const Vec3 p{0.25, 0.5, 0};
  soup.push_back({p, p, p});
  soup.push_back({p, p, {1, 1, 1}});  // the edge is taken in both directions
  EXPECT_EQ(balance(soup).unbalanced_edges, 0u);
}

TEST(EdgeBalance, FindsTheEdgesOfAHole) {
  Soup soup = tetrahedron();
  soup.pop_back();  // c d a
  const EdgeBalance found = balance(soup, 40);
  EXPECT_EQ(found.unbalanced_edges, 3u);
  const std::uint64_t triangles[] = {40, 41, 42};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found.first[i].triangle, triangles[i]);
    EXPECT_EQ(found.first[i].along, 1u);
    EXPECT_EQ(found.first[i].against, 0u);
  }
  // Triangle 40 is a b c. Its unbalanced edge runs from c to a; the model frame equals the input
  // here.
  EXPECT_EQ(found.first[0].from, Point(1, 0, 0));
  EXPECT_EQ(found.first[0].to, Point(0, 0, 0));
}

TEST(EdgeBalance, FindsAFlippedFace) {
  Soup soup = sphere(3);
  std::swap(soup[17][0], soup[17][1]);
  const EdgeBalance found = balance(soup);
  EXPECT_EQ(found.unbalanced_edges, 3u);
  EXPECT_TRUE(std::ranges::any_of(found.first, [](const UnbalancedEdge& edge) {
    return edge.along + edge.against == 2 && edge.along != edge.against;
  }));
}

TEST(EdgeBalance, ListsTheFirstEdgesInTheInputsOrder) {
  const EdgeBalance found = balance(height_field(9));
  EXPECT_EQ(found.unbalanced_edges, 36u);
  EXPECT_LE(found.first[0].triangle, found.first[1].triangle);
  EXPECT_LE(found.first[1].triangle, found.first[2].triangle);
  EXPECT_EQ(found.first[0].triangle, 0u);
}

// Counted in many parts.
TEST(EdgeBalance, CountsAnEdgeOnceForAnyNumberOfFaces) {
  Soup soup = repeated(60000);
  const EdgeBalance found = balance(soup);
  EXPECT_EQ(found.unbalanced_edges, 3u);
  for (const UnbalancedEdge& edge : found.first) {
    EXPECT_EQ(edge.triangle, 0u);
    EXPECT_EQ(edge.along, 60000u);
    EXPECT_EQ(edge.against, 0u);
  }
  for (std::size_t i = 0; i < soup.size(); i += 2) std::swap(soup[i][0], soup[i][1]);
  EXPECT_EQ(balance(soup).unbalanced_edges, 0u);
}

// Two models; the coordinates of one hardly differ in the scale of the other.
TEST(EdgeBalance, DistinguishesSmallEdges) {
  Soup soup = sphere(6);
  for (auto& triangle : soup)
    for (Vec3& corner : triangle)
      corner = {corner.x * 0x1p-20, corner.y * 0x1p-20, corner.z * 0x1p-20};
  soup = both(soup, tetrahedron());
  EXPECT_EQ(balance(soup).unbalanced_edges, 0u);
  for (const std::size_t triangle : {30000, 20000, 700, 10000}) soup[triangle][0] = soup[0][0];
  const EdgeBalance found = balance(soup);
  EXPECT_EQ(found.unbalanced_edges, 16u);
  for (const UnbalancedEdge& edge : found.first) EXPECT_NE(edge.along, edge.against);
}

TEST(EdgeBalance, DoesNotDependOnThreadsOrParts) {
  const SampleMesh mesh = store(scattered(3000, 0.2));
  const EdgeBalance many = balance_of(mesh, 100);
  EXPECT_EQ(many.unbalanced_edges, 9000u);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const EdgeBalance alone = balance_of(mesh);
  EXPECT_EQ(alone.unbalanced_edges, many.unbalanced_edges);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(alone.first[i].triangle, many.first[i].triangle);
    EXPECT_EQ(alone.first[i].from, many.first[i].from);
  }
}

}  // namespace
}  // namespace planetree::octree
