#include "octree/builder/sort/triangle_spool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "octree/builder/sort/morton_order.h"
#include "octree/geometry/octcode.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

double longest_edge(const SampleMesh& mesh) {
  return (mesh.frame.upper() - mesh.frame.lower()).maxCoeff();
}

TEST(TriangleSpool, RoundTripsFloatsAsFloats) {
  const SampleMesh mesh = store({{Vec3{0.5, 1, 2}, Vec3{-3, 0.125, 0}, Vec3{1e-3f, 7, 0}}});
  EXPECT_FALSE(mesh.float64());
  const double scale = std::ldexp(1.0, mesh.frame.scale_exponent);
  EXPECT_EQ(mesh.corners(0)[1], Point(-3, 0.125, 0) * scale);
  EXPECT_EQ(mesh.corners(0)[2].x(), 1e-3f * scale);
}

TEST(TriangleSpool, StoresDoublesFromTheFirstInexactFloatOn) {
  const std::array<Vec3, 3> narrow{Vec3{0.5, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  const std::array<Vec3, 3> wide{Vec3{0.5, 0, 0}, Vec3{1, 0.1, 0}, Vec3{0, 1, 0}};
  EXPECT_FALSE(store({narrow}).float64());
  const SampleMesh mesh = store({narrow, wide});
  EXPECT_TRUE(mesh.float64());
  const double scale = std::ldexp(1.0, mesh.frame.scale_exponent);
  EXPECT_EQ(mesh.corners(0)[0], Point(0.5, 0, 0) * scale);
  EXPECT_EQ(mesh.corners(1)[1].y(), 0.1 * scale);
}

TEST(TriangleSpool, ScalesTheLongestEdgeIntoOneToTwo) {
  for (const double size : {1e-300, 3e-39, 1e-3, 0.99, 1.0, 1.01, 12345.0, 3e38, 1e300, 1.7e308}) {
    const SampleMesh mesh = store({{Vec3{0, 0, 0}, Vec3{size, 0, 0}, Vec3{0, size / 3, 0}},
                                   {Vec3{0, 0, 0}, Vec3{size, 0, 0}, Vec3{0, 0, -size / 7}}});
    EXPECT_GE(longest_edge(mesh), 1) << size;
    EXPECT_LT(longest_edge(mesh), 2) << size;
    EXPECT_EQ(mesh.frame.input_upper.x(), size);
  }
}

TEST(TriangleSpool, ScalesBoxesWhoseSizeOverflows) {
  constexpr double kMax = std::numeric_limits<double>::max();
  const SampleMesh mesh = store({{Vec3{-kMax, 0, 0}, Vec3{kMax, 0, 0}, Vec3{0, 1, 0}}});
  EXPECT_GE(longest_edge(mesh), 1);
  EXPECT_LE(longest_edge(mesh), 2);
}

TEST(TriangleSpool, ScalesASinglePointByItsCoordinates) {
  const SampleMesh mesh = store({{Vec3{1000, 0, 0}, Vec3{1000, 0, 0}, Vec3{1000, 0, 0}}});
  EXPECT_LT(std::fabs(mesh.corners(0)[0].x()), 2);
  EXPECT_EQ(store({{Vec3{}, Vec3{}, Vec3{}}}).frame.scale_exponent, 0);
}

TEST(TriangleSpool, StoresDoublesWhereScaledFloatsUnderflow) {
  // 1e-38 beside 1e38 would underflow in float32 once scaled to the model frame.
  const SampleMesh mesh = store({{Vec3{1e-38f, 0, 0}, Vec3{1e38f, 0, 0}, Vec3{0, 1e38f, 0}}});
  EXPECT_EQ(mesh.corners(0)[0].x(), std::ldexp(double{1e-38f}, mesh.frame.scale_exponent));
  EXPECT_TRUE(mesh.float64());
}

TEST(TriangleSpool, CountsSkippedRecords) {
  const std::array<Vec3, 3> corners{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  TriangleSpool spool(100, 0, spill_file());
  SkippedRecord why;
  ASSERT_TRUE(spool.triangle(0, corners));
  spool.skipped(1, 3, why);
  ASSERT_TRUE(spool.triangle(4, corners));
  spool.skipped(5, 1, why);
  ASSERT_TRUE(spool.triangle((std::uint64_t{1} << 32) + 7, corners));
  const auto frame = spool.finish();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->triangle_count, 3u);
  EXPECT_EQ(frame->skipped_count, 4u);
  EXPECT_EQ(frame->first_skipped, 1u);
  EXPECT_EQ(frame->first_skipped_text, why.text());
  const auto batch = spool.take_batch(0);
  ASSERT_TRUE(batch);
  ASSERT_EQ(batch->size(), 3u);
  EXPECT_EQ(batch->index(0), 0u);
  EXPECT_EQ(batch->index(1), 4u);
  EXPECT_EQ(batch->index(2), (std::uint64_t{1} << 32) + 7);
}

// The last of ten parts is the first with doubles. Parts in memory and spilled parts are the same.
TEST(TriangleSpool, GivesTheSameTrianglesFromMemoryAndDisk) {
  Soup soup = sphere(4);
  soup.back()[1].y += 0.1;
  const SampleMesh whole = store(soup);
  ASSERT_TRUE(whole.float64());
  for (const std::uint64_t held : {0, 20000, 1 << 30}) {
    TriangleSpool spool(211, held, spill_file());
    for (std::size_t i = 0; i < soup.size(); ++i) ASSERT_TRUE(spool.triangle(i, soup[i]));
    ASSERT_TRUE(spool.finish());
    ASSERT_EQ(spool.batch_count(), 10u);
    std::uint32_t at = 0;
    for (std::size_t batch = 0; batch < 10; ++batch) {
      const auto some = spool.take_batch(batch);
      ASSERT_TRUE(some);
      for (std::uint32_t i = 0; i < some->size(); ++i, ++at) {
        ASSERT_EQ(some->key(i), whole.key(at));
        ASSERT_EQ(some->corners(i), whole.corners(at));
      }
    }
    EXPECT_EQ(at, whole.size());
  }
}

TEST(Triangles, SortByCodeThenIndex) {
  const SampleMesh mesh = store(scattered(3000, 0.01));
  Triangles sorted = mesh;
  sorted.sort();
  ASSERT_EQ(sorted.size(), 3000u);
  for (std::uint32_t i = 0; i < sorted.size(); ++i) {
    EXPECT_TRUE(i == 0 || sorted.key(i - 1) < sorted.key(i));
    const auto at = static_cast<std::uint32_t>(sorted.index(i));
    EXPECT_EQ(sorted.code(i), mesh.code(at));
    EXPECT_EQ(sorted.corners(i), mesh.corners(at));
  }
}

TEST(MortonOrder, PutsBoxCentresInTheirCells) {
  const SampleMesh mesh = store(scattered(500, 0.01));
  for (const MortonKey& key : keys_of(mesh)) {
    const Triangle t = mesh.corners(key.position);
    const Point centre =
        (t[0].cwiseMin(t[1]).cwiseMin(t[2]) + t[0].cwiseMax(t[1]).cwiseMax(t[2])) / 2;
    const Cell cell = cell_of_octcode(octcode_of_prefix(key.code, kMortonBits));
    const Point corner = mesh.frame.lower() + Point(cell.x, cell.y, cell.z) * 0x1p-18;
    EXPECT_GE((centre - corner).minCoeff(), -1e-12);
    EXPECT_LE((centre - corner).maxCoeff(), 0x1p-18 + 1e-12);
  }
}

}  // namespace
}  // namespace planetree::octree
