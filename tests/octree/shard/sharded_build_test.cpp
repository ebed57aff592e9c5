// The bytes of a sharded build are those of a build in one process.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <limits>

#include "tests/octree/builder/mesh/gltf/gltf_writer.h"
#include "tests/octree/shard/sharded_build.h"

namespace planetree::octree {
namespace {

Soup open_sphere() {
  Soup soup = sphere(3);
  soup.resize(soup.size() - 9);
  return soup;
}

TEST_F(ShardedBuild, WritesTheSameBytesOfClosedAndOpenSurfaces) {
  for (const Soup& soup : {sphere(3), open_sphere(), repeated(300), grains(60, 0.3)}) {
    write(soup);
    expect_same();
  }
}

TEST_F(ShardedBuild, WritesTheSameBytesWithMuchMemoryAndManyThreads) {
  write(open_sphere());
  for (const BuildMemory& memory : {kLarge, kBetween, kSortedOnDisk}) {
    memory_ = memory;
    expect_same({3});
  }
}

TEST_F(ShardedBuild, WritesTheSameBytesOfAMeshInRandomOrder) {
  memory_ = kSortedOnDisk;
  write_in_random_order(open_sphere());
  expect_same({2, 5});
}

TEST_F(ShardedBuild, WritesTheSameBytesOfFewTriangles) {
  // More shards than triangles, and than chunks.
  Soup soup = sphere(1);
  soup.resize(3);
  write(soup);
  expect_same({1, 2, 9});
}

TEST_F(ShardedBuild, WritesTheSameBytesWithStrays) {
  Soup soup = sphere(3);
  for (Vec3& corner : soup[5]) corner = {corner.x + 4e6, corner.y, corner.z - 3e6};
  write(soup);
  expect_same({1, 3});
  const auto report = merge();
  ASSERT_TRUE(report);
  EXPECT_EQ(report->frame.stray_count, 1u);
}

TEST_F(ShardedBuild, WritesTheSameBytesWithDoubles) {
  Soup soup = open_sphere();
  for (auto& triangle : soup)
    for (Vec3& corner : triangle) corner.x *= 1.0 / 3;
  std::ofstream file(mesh_);
  file << "solid doubles\n";
  file.precision(17);
  for (const auto& triangle : soup) {
    file << "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& corner : triangle)
      file << "vertex " << corner.x << ' ' << corner.y << ' ' << corner.z << '\n';
    file << "endloop\nendfacet\n";
  }
  file << "endsolid\n";
  file.close();
  expect_same({1, 4});
}

TEST_F(ShardedBuild, WritesTheSameBytesWithSkippedRecords) {
  Soup soup = open_sphere();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::size_t bad : {0, 7, 8, 9, 200}) soup[bad][1].y = nan;
  write(soup);
  expect_same({2, 7});
  const auto report = merge();
  ASSERT_TRUE(report);
  EXPECT_EQ(report->frame.skipped_count, 5u);
}

TEST_F(ShardedBuild, WritesTheSameBytesWithoutLayers) {
  write(open_sphere());
  for (const std::uint32_t layers : {kDistanceLayer, kDistanceLayer | kSideLayer}) {
    options_.layers = layers;
    expect_same({3});
  }
}

TEST_F(ShardedBuild, WritesTheSameBytesOfOtherOptions) {
  write(open_sphere());
  options_.page_bytes = 8192;
  options_.side = storage::SideRule::kSurface;
  options_.metadata = {{"title", "an open sphere"}, {"unit", "mm"}};
  options_.keep = kKeepTriangles;
  expect_same({3});
}

TEST_F(ShardedBuild, WritesTheSameBytesOfACompressedMesh) {
  write(open_sphere());
  const std::string command =
      "gzip --force " + mesh_.string() + " && mv " + mesh_.string() + ".gz " + mesh_.string();
  ASSERT_EQ(std::system(command.c_str()), 0);
  expect_same({3});
}

TEST_F(ShardedBuild, KeepsAttributes) {
  std::ofstream file(mesh_);
  const Soup soup = open_sphere();
  file << "ply\nformat ascii 1.0\nelement vertex " << 3 * soup.size()
       << "\nproperty float x\nproperty float y\nproperty float z\n"
          "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face "
       << soup.size()
       << "\nproperty list uchar int vertex_indices\nproperty int value\nend_header\n";
  int number = 0;
  for (const auto& triangle : soup)
    for (const Vec3& corner : triangle) {
      file << static_cast<float>(corner.x) << ' ' << static_cast<float>(corner.y) << ' '
           << static_cast<float>(corner.z) << ' ' << number % 251 << ' ' << number % 7 << " 9\n";
      ++number;
    }
  for (std::size_t i = 0; i < soup.size(); ++i)
    file << "3 " << 3 * i << ' ' << 3 * i + 1 << ' ' << 3 * i + 2 << ' ' << i * 17 << '\n';
  file.close();
  options_.keep = kKeepTriangles | kKeepColor | kKeepValue;
  expect_same({1, 4});
}

TEST_F(ShardedBuild, NeedsNoMeshAfterTheMaps) {
  write(open_sphere());
  const storage::Bytes expected = whole();
  ASSERT_TRUE(plan(2));
  ASSERT_TRUE(map(0) && map(1));
  std::filesystem::remove(mesh_);
  ASSERT_TRUE(reduce(0) && reduce(1));
  const auto merged = merge();
  ASSERT_TRUE(merged) << merged.error().text;
  EXPECT_EQ(built(), expected);
}

TEST_F(ShardedBuild, SortsEveryTriangleInOneShard) {
  write(open_sphere());
  ASSERT_TRUE(plan(4));
  std::uint64_t sorted = 0, built = 0, chunks = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const auto done = map(i);
    ASSERT_TRUE(done);
    // Triangles nearby are alike, and packed.
    EXPECT_LT(done->bytes, done->triangles * 45);
    sorted += done->triangles;
  }
  for (std::uint32_t i = 0; i < 4; ++i) {
    const auto done = reduce(i);
    ASSERT_TRUE(done);
    EXPECT_LT(done->triangles, open_sphere().size() / 2);
    built += done->triangles;
    chunks += done->chunks;
  }
  EXPECT_EQ(sorted, open_sphere().size());
  EXPECT_EQ(built, open_sphere().size());
  EXPECT_GT(chunks, 8u);
}

}  // namespace
}  // namespace planetree::octree
