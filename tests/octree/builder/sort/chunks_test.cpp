#include "octree/builder/sort/chunks.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "octree/builder/mask/mask_sectors.h"
#include "tests/octree/support/sample_mask.h"

namespace planetree::octree {
namespace {

struct ChunkCase {
  const char* name;
  Soup soup;
};

std::vector<ChunkCase> chunk_cases() {
  return {{"sphere", sphere(4)},
          {"grains", grains(200, 0.2)},
          {"in one place", repeated(1000)},
          {"one triangle", repeated(1)},
          {"scattered", scattered(2000, 0.5)}};
}

TEST(Chunks, HoldEveryTriangleOnceInOrder) {
  for (const ChunkCase& c : chunk_cases()) {
    SCOPED_TRACE(c.name);
    const SampleMesh mesh = store(c.soup);
    Triangles sorted = mesh;
    sorted.sort();
    const auto runs = runs_of(mesh, 300);
    const auto tree = cut_chunks(*runs, false, 100);
    ASSERT_TRUE(tree);
    std::uint32_t at = 0;
    for (const Chunk& chunk : tree->chunks) {
      const auto triangles = runs->read(chunk.from, chunk.to);
      ASSERT_TRUE(triangles);
      EXPECT_EQ(triangles->size(), chunk.size);
      EXPECT_GE(chunk.size, 1u);
      EXPECT_LE(chunk.size, 100u);
      for (std::uint32_t i = 0; i < triangles->size(); ++i, ++at) {
        ASSERT_EQ(triangles->key(i), sorted.key(at));
        ASSERT_EQ(triangles->corners(i), sorted.corners(at));
      }
    }
    EXPECT_EQ(at, sorted.size());
  }
}

TEST(Chunks, AreTheLeavesOfTheirTree) {
  for (const ChunkCase& c : chunk_cases()) {
    SCOPED_TRACE(c.name);
    const auto runs = runs_of(store(c.soup));
    const auto tree = cut_chunks(*runs, false, 100);
    ASSERT_TRUE(tree);
    std::size_t leaves = 0;
    for (std::size_t at = 0; at < tree->nodes.size(); ++at) {
      const ChunkNode& node = tree->nodes[at];
      if (node.leaf()) {
        EXPECT_EQ(node.begin, leaves++);
        EXPECT_EQ(node.end, node.begin + 1);
        continue;
      }
      EXPECT_GT(node.left, at);
      EXPECT_GT(node.right, at);
      EXPECT_EQ(tree->nodes[node.left].begin, node.begin);
      EXPECT_EQ(tree->nodes[node.left].end, tree->nodes[node.right].begin);
      EXPECT_EQ(tree->nodes[node.right].end, node.end);
    }
    EXPECT_EQ(leaves, tree->chunks.size());
  }
}

TEST(Chunks, DoNotDependOnTheRuns) {
  const SampleMesh mesh =
      store(joined({grains(300, 0.1), repeated(500), inside_out(repeated(500))}));
  std::vector<std::vector<std::uint64_t>> sizes;
  for (const std::uint32_t run_triangles : {50u, 333u, 100000u}) {
    const auto runs = runs_of(mesh, run_triangles);
    const auto tree = cut_chunks(*runs, false, 60);
    ASSERT_TRUE(tree);
    sizes.emplace_back();
    for (const Chunk& chunk : tree->chunks) sizes.back().push_back(chunk.size);
  }
  EXPECT_GT(sizes[0].size(), 30u);
  EXPECT_EQ(sizes[0], sizes[1]);
  EXPECT_EQ(sizes[0], sizes[2]);
}

// With each triangle there as a cap too, a sector holds half as many of them.
TEST(MaskSectors, AreDividedByTrianglesAndCaps) {
  const SampleMesh mesh = store(sphere(4));
  const auto runs = runs_of(mesh, 200), caps = runs_of(mesh, 300);
  MaskSectors alone(mesh.lower(), {}, 0, mesh.float64(), 2000, spill_file());
  MaskSectors with_caps(mesh.lower(), {}, 0, mesh.float64(), 2000, spill_file());
  ASSERT_TRUE(alone.divide(*runs, nullptr, false, 40));
  ASSERT_TRUE(with_caps.divide(*runs, caps.get(), false, 80));
  EXPECT_GT(alone.all().size(), 20u);
  ASSERT_EQ(with_caps.all().size(), alone.all().size());
  for (std::size_t at = 0; at < alone.all().size(); ++at)
    EXPECT_EQ(with_caps.all()[at].first_octant, alone.all()[at].first_octant);
}

// Compares the triangles read for each sector with a geometric test that shares no code with it.
TEST(MaskSectors, ReadAllTrianglesThatTouchThem) {
  for (const Soup& soup : {grains(200, 0.3), sphere(4), box({0, 0, 0}, {1, 1, 1}, 9)}) {
    const SampleMesh mesh = store(soup);
    const Surface surface(mesh);
    const auto runs = runs_of(mesh, 200);
    MaskSectors sectors(mesh.lower(), {}, 0, mesh.float64(), 2000, spill_file());
    ASSERT_TRUE(sectors.divide(*runs, nullptr, false, 40));
    ASSERT_TRUE(sectors.add(mesh));
    std::size_t undivided = 0;
    for (std::size_t at = 0; at < sectors.all().size(); ++at) {
      const MaskSectors::Region& region = sectors.all()[at];
      if (region.divided()) continue;
      ++undivided;
      const auto read = sectors.read(at, *runs);
      ASSERT_TRUE(read);
      EXPECT_EQ(region.touched, read->size() > 0);
      const Point lower = sectors.grid().lower(region.cell);
      const std::size_t touching =
          surface.touching(lower, sectors.grid().upper(region.cell)).size();
      EXPECT_GE(read->size(), touching);
      EXPECT_LE(read->size(), touching + touching / 8 + 2) << "a test that tells little apart";
      for (std::uint32_t i = 1; i < read->size(); ++i) EXPECT_LT(read->key(i - 1), read->key(i));
      // The change of winding numbers between corners matches the surface.
      for (unsigned corner = 1; corner < 8; ++corner)
        EXPECT_EQ(region.rise[corner], surface.winding(sectors.grid().corner(region.cell, corner)) -
                                           surface.winding(lower));
    }
    EXPECT_GT(undivided, 20u);
  }
}

}  // namespace
}  // namespace planetree::octree
