// Normals computed from the coherence cache have the same bits for less work.

#include "octree/nearest/feature_normal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "octree/nearest/coherence_cache.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

// A flat cone of `faces` faces about (0, 0, 0.1), with its rim at distance 1 from the axis.
Soup cone(unsigned faces) {
  const auto rim = [&](unsigned i) {
    const double angle = 6.283185307179586 * (i % faces) / faces;
    return Vec3{std::cos(angle), std::sin(angle), 0};
  };
  Soup soup;
  for (unsigned i = 0; i < faces; ++i) soup.push_back({Vec3{0, 0, 0.1}, rim(i), rim(i + 1)});
  return soup;
}

// Work of feature_normal() along a path, with and without the coherence cache.
struct Path {
  explicit Path(const Soup& soup) : sample(build_sample(soup, 65536)), pages(sample) {}

  void expect_same_normals(Point at, double step) {
    const TreeInfo tree = tree_info(sample);
    Noise noise(7);
    CoherenceCache coherence_cache;
    for (int i = 0; i < 400; ++i) {
      // A leap ends outside of the ball, which stays.
      const double way = i % 20 == 19 ? 0.2 : step;
      const Vec3 by = noise.point(-way, way);
      at += Point(by.x, by.y, by.z);
      TraversalStats unused;
      const NearestAnswer nearest_there =
          nearest(tree, at, {}, pages.reader(), unused, &coherence_cache);
      FeatureNormal before, found;
      feature_normal(tree, at, nearest_there, nullptr, kAll, pages.reader(), alone, before);
      feature_normal(tree, at, nearest_there, &coherence_cache, kAll, pages.reader(), along, found);
      EXPECT_EQ(found.normal, before.normal) << i;
      EXPECT_EQ(found.side, before.side) << i;
      EXPECT_TRUE(found.complete);
      const bool held = coherence_cache.has_all_at(nearest_there.point);
      from_subtrees += held && !coherence_cache.triangles().complete() ? 1 : 0;
    }
  }

  static constexpr std::uint64_t kAll = 1'000'000;

  SampleTree sample;
  SamplePages pages;
  TraversalStats alone, along;
  int from_subtrees = 0;
};

TEST(FeatureNormalFromCache, MatchesTraversalFromTheRootWithLessWork) {
  const std::pair<const char*, Soup> soups[] = {{"sphere", sphere(6)},
                                                {"sheet", height_field(60)},
                                                {"scattered triangles", scattered(20000, 0.05)}};
  for (const auto& [name, soup] : soups) {
    SCOPED_TRACE(name);
    Path path(soup);
    path.expect_same_normals(Point(0.45, 0.2, 0.1), 0.005);
    EXPECT_GT(path.from_subtrees, 100);
    EXPECT_LT(path.along.nodes, path.alone.nodes / 2);
    EXPECT_LE(path.along.blocks, path.alone.blocks);
  }
}

// The sum of so many normals depends on the order of the tree.
TEST(FeatureNormalFromCache, MatchesTraversalFromTheRootWithManyFacesAtAVertex) {
  for (const unsigned faces : {150u, 400u}) {
    SCOPED_TRACE(std::to_string(faces) + " faces");
    Path path(cone(faces));
    path.expect_same_normals(Point(0, 0, 0.3), 0.001);
    EXPECT_GT(path.alone.blocks, 0u);
  }
}

}  // namespace
}  // namespace planetree::octree
