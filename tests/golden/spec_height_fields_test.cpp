// Checks "Height fields" in the samples, as the independent reader decodes them, against sums of
// solid angles.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "tests/golden/samples.h"
#include "tests/golden/spec_tree.h"
#include "tests/golden/spec_vector.h"

namespace planetree::golden {
namespace {

SpecPoint sum(const SpecPoint& a, double share, const SpecPoint& b) {
  return {a[0] + share * b[0], a[1] + share * b[1], a[2] + share * b[2]};
}

SpecPoint normal_of(const SpecTriangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  return cross(b - a, c - a);
}

struct HeightFieldSample {
  explicit HeightFieldSample(const Sample& sample)
      : HeightFieldSample(SpecFile(read_file(sample.ptree_path()))) {}
  explicit HeightFieldSample(const SpecFile& file)
      : tree(file), all(tree.triangles(tree.root_link())) {
    if (!tree.header().open()) return;
    const SpecTree caps(file, SpecTree::Of::kCaps);
    const std::vector<SpecTriangle> triangles = caps.triangles(caps.root_link());
    all.insert(all.end(), triangles.begin(), triangles.end());
  }

  // Calls look(block) for every height field and returns their number.
  std::size_t each_height_field(const std::function<void(const SpecBlock&)>& look) const {
    std::size_t count = 0;
    for (const SpecPage& page : tree.pages())
      for (const auto& [link, block] : page.blocks)
        if (block.is_height_field) {
          look(block);
          ++count;
        }
    return count;
  }

  SpecTree tree;
  std::vector<SpecTriangle> all;  // of the closed surface
};

void expect_sides_of_faces(const HeightFieldSample& file) {
  const std::size_t count = file.each_height_field([&](const SpecBlock& block) {
    for (const SpecTriangle& triangle : block.triangles) {
      const auto& [a, b, c] = triangle.corners;
      const SpecPoint centre = sum(sum(sum({}, 1. / 3, a), 1. / 3, b), 1. / 3, c);
      const SpecPoint normal = normal_of(triangle);
      const double length = std::sqrt(dot(normal, normal));
      ASSERT_GT(length, 0);
      for (const double by : {1e-5, -1e-5}) {
        const SpecPoint point = sum(centre, by / length, normal);
        EXPECT_NEAR(winding_number(file.all, point), by > 0 ? 0 : 1, 1e-6) << triangle.id;
      }
    }
  });
  EXPECT_GT(count, 0u);
}

TEST(SpecHeightFields, HaveTheOutsideInFrontAndTheInsideBehind) {
  for (const Sample& sample : {sphere_sample(), boxes_sample()})
    expect_sides_of_faces(HeightFieldSample(sample));
}

// A sphere with a hole: no cap touches the boxes of height fields.
TEST(SpecHeightFields, AreAwayFromTheHolesOfOpenSurfaces) {
  const HeightFieldSample file{SpecFile(build_with_hole(sphere_sample(), 12))};
  EXPECT_TRUE(file.tree.header().open());
  expect_sides_of_faces(file);
}

// The file does not store the direction, but one exists for all triangles of the block.
TEST(SpecHeightFields, RiseInOneDirection) {
  const HeightFieldSample file(sphere_sample());
  file.each_height_field([](const SpecBlock& block) {
    SpecPoint direction{};
    for (const SpecTriangle& triangle : block.triangles)
      direction = sum(direction, 1, normal_of(triangle));
    for (const SpecTriangle& triangle : block.triangles) {
      const SpecPoint normal = normal_of(triangle);
      EXPECT_GE(dot(normal, direction),
                0.0625 * std::sqrt(dot(normal, normal) * dot(direction, direction)));
    }
  });
}

// Most blocks of a sphere are height fields. There the face at a nearest point tells the side.
TEST(SpecHeightFields, TellTheSideByTheFaceAtANearestPoint) {
  const HeightFieldSample file(sphere_sample());
  std::size_t blocks = 0, certain = 0;
  for (const SpecPage& page : file.tree.pages()) blocks += page.blocks.size();
  const std::size_t count = file.each_height_field([&](const SpecBlock& block) {
    const SpecTriangle& triangle = block.triangles.front();
    const auto& [a, b, c] = triangle.corners;
    const SpecPoint foot = sum(sum(sum({}, 0.5, a), 0.3, b), 0.2, c);
    const SpecPoint normal = normal_of(triangle);
    for (const double by : {0.02, -0.02}) {
      const SpecPoint point = sum(foot, by / std::sqrt(dot(normal, normal)), normal);
      if (file.tree.nearest(point).triangle != triangle.id) continue;
      EXPECT_NEAR(winding_number(file.all, point), by > 0 ? 0 : 1, 1e-6);
      ++certain;
    }
  });
  EXPECT_GT(2 * count, blocks);
  EXPECT_GT(certain, count);
}

TEST(SpecHeightFields, AreNotInFilesOfRegions) {
  EXPECT_EQ(HeightFieldSample(region_sample()).each_height_field([](const SpecBlock&) {}), 0u);
}

}  // namespace
}  // namespace planetree::golden
