#include "octree/winding/crossings.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/octree/support/sample_mask.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

constexpr std::uint64_t kEveryNode = ~std::uint64_t{0};

// Crossings counted triangle by triangle.
Crossings count_all(const SampleMesh& mesh, const PerturbedSegment& segment) {
  Crossings count;
  for (std::uint32_t i = 0; i < mesh.size(); ++i) {
    count.on_surface = count.on_surface || lies_on(segment.from, mesh.corners(i));
    count.difference += crossing(segment, mesh.corners(i));
  }
  return count;
}

Point point_in(const Vec3& p) { return {p.x, p.y, p.z}; }

void expect_as_one_by_one(const Soup& soup, std::uint64_t seed) {
  const SampleTree sample = build_sample(soup);
  SamplePages pages(sample);
  const TreeInfo tree = tree_info(sample);
  Noise noise(seed);
  for (int i = 0; i < 300; ++i) {
    const Point corner = sample.mesh.corners(noise.bits() % sample.mesh.size())[0];
    const Point from = i % 4 == 0 ? corner : point_in(noise.point(-1, 1));
    Point to = point_in(noise.point(-1, 1));
    if (i % 3 == 0) to = {from.x(), from.y(), 3};
    if (i % 5 == 0) to = from + 0.05 * (to - from);
    if (i % 50 == 0) to = from;
    TraversalStats work;
    const Crossings found = count_crossings(tree, {from, to}, kEveryNode, pages.reader(), work);
    const Crossings expected = count_all(sample.mesh, {from, to});
    ASSERT_TRUE(found.complete);
    ASSERT_EQ(found.on_surface, expected.on_surface) << i;
    if (!expected.on_surface) {
      ASSERT_EQ(found.difference, expected.difference) << i;
    }
  }
}

TEST(CountCrossings, IsTheSumOverAllTriangles) {
  expect_as_one_by_one(sphere(4), 1);
  expect_as_one_by_one(height_field(20), 2);
  expect_as_one_by_one(scattered(600, 0.3), 3);
  expect_as_one_by_one(repeated(50), 4);
  expect_as_one_by_one(repeated(1), 5);
}

// At these offsets the spacing of floats is as large as that of vertices.
TEST(CountCrossings, IsTheSumOverAllTrianglesFarFromTheOrigin) {
  for (const double offset : {1e3, 1e5, 1e7}) {
    expect_as_one_by_one(translated(sphere(4), {offset, -offset, 0}), 6);
  }
}

// Expects a segment out of a sphere to cross it, by visiting fewer than `too_many` nodes and
// blocks.
void expect_little_work(const PerturbedSegment& segment, std::uint64_t too_many) {
  const SampleTree sample = build_sample(sphere(6));
  SamplePages pages(sample);
  TraversalStats work;
  const Crossings found =
      count_crossings(tree_info(sample), segment, kEveryNode, pages.reader(), work);
  EXPECT_NE(found.difference, 0);
  EXPECT_LT(work.nodes + work.blocks, too_many);
  EXPECT_LT(work.triangles, 8u);
}

TEST(CountCrossings, VisitsOnlyRecordsOnTheSegment) {
  expect_little_work({{0.1, 0.2, 0}, {0.1, 0.2, 3}}, 40);
}

// The bounding box of the segment would hold an eighth of the model.
TEST(CountCrossings, VisitsOnlyRecordsOnADiagonalSegment) {
  expect_little_work({{0.01, 0.02, 0}, {2, 2.1, 2.2}}, 20);
}

TEST(CountCrossings, IsIncompleteWhereWorkOrPagesEnd) {
  const SampleTree sample = build_sample(sphere(5));
  SamplePages pages(sample);
  const TreeInfo tree = tree_info(sample);
  const PerturbedSegment segment{{0.1, 0.2, 0}, {0.1, 0.2, 3}};
  TraversalStats work;
  ASSERT_TRUE(count_crossings(tree, segment, kEveryNode, pages.reader(), work).complete);
  const std::uint64_t needed = work.units;
  EXPECT_TRUE(count_crossings(tree, segment, needed, pages.reader(), work).complete);
  EXPECT_FALSE(count_crossings(tree, segment, needed - 1, pages.reader(), work).complete);
  EXPECT_FALSE(count_crossings(tree, segment, 0, pages.reader(), work).complete);
  for (std::uint32_t page = 1; page < pages.size(); ++page) pages.withhold(page);
  EXPECT_FALSE(count_crossings(tree, segment, kEveryNode, pages.reader(), work).complete);
}

}  // namespace
}  // namespace planetree::octree
