#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "octree/builder/mask/distinct_triangles.h"
#include "octree/builder/mask/height_field_finder.h"
#include "octree/builder/mask/mask_sectors.h"
#include "octree/builder/mask/sector_mask.h"
#include "octree/geometry/cell_overlap.h"
#include "tests/octree/support/degenerate_meshes.h"
#include "tests/octree/support/height_field_model.h"
#include "tests/octree/support/sample_mask.h"

// What fans, needles and copies cost, in counts of work.
namespace planetree::octree {
namespace {

Soup degenerate(std::string_view kind, std::uint32_t triangles) {
  return degenerate_kind(kind)->make(triangles).soup();
}

std::size_t sector_count(const SampleMesh& mesh, std::uint64_t max_triangles) {
  const auto runs = runs_of(mesh);
  MaskSectors sectors(mesh.lower(), {}, 0, mesh.float64(), 2000, spill_file());
  EXPECT_TRUE(sectors.divide(*runs, nullptr, false, max_triangles));
  return sectors.all().size();
}

TEST(DistinctTriangles, StandForTheirCopies) {
  const Soup one = repeated(1);
  Soup soup;
  // Of equal codes: three corners in two orders, in turns.
  for (int i = 0; i < 50; ++i) soup = joined({soup, one, inside_out(one)});
  soup = joined({soup, translated(one, {3, 0, 0})});
  SampleMesh mesh = store(soup);
  mesh.sort();
  std::vector<std::int64_t> copies;
  for (const BoxedTriangle& triangle : distinct(mesh)) copies.push_back(triangle.copies);
  EXPECT_EQ(copies, (std::vector<std::int64_t>{50, 50, 1}));
}

TEST(DistinctTriangles, AreAllOfAnOrdinaryModel) {
  SampleMesh mesh = store(sphere(4));
  mesh.sort();
  const auto found = distinct(mesh);
  ASSERT_EQ(found.size(), mesh.size());
  for (std::uint32_t i = 0; i < mesh.size(); ++i) ASSERT_EQ(found[i].corners, mesh.corners(i));
}

// Every sector that is in vain lists all of the triangles once more.
TEST(MaskSectors, AreNotDividedWhereTrianglesCoincide) {
  EXPECT_EQ(sector_count(store(repeated(2000)), 100), 1u);
  EXPECT_GT(sector_count(store(sphere(5)), 100), 100u);
  // The ball's triangles are separated, those in one place are not.
  const Soup both = joined({translated(sphere(4), {2, 0, 0}), repeated(4000)});
  const std::size_t sectors = sector_count(store(both), 100);
  EXPECT_GT(sectors, 50u);
  EXPECT_LT(sectors, 500u);
}

TEST(MaskTree, ListsNoBlocksForCellsWithTooManyTriangles) {
  SampleMesh mesh = store(degenerate("cylinder-1K", 20000));
  mesh.sort();
  const ClippedGrid grid(mesh.lower());
  std::size_t lists = 0;
  const auto list = [&](const GridCell& cell, MaskBlocks&) {
    ++lists;
    std::size_t touching = 0;
    if (lists % 256 != 0) return false;
    for (std::uint32_t i = 0; i < mesh.size(); ++i)
      touching += may_touch(mesh.corners(i), grid.lower(cell), grid.upper(cell));
    EXPECT_LE(touching, kMaxListed * kMaxBlockTriangles);
    return false;
  };
  const MaskTree mask = mask_of_sector(grid, {}, 0, 1, mesh, list);
  std::size_t leaves = 0;
  for (const MaskEntry& entry : mask.entries) leaves += entry.kind == MaskEntry::Kind::kCorners;
  EXPECT_GT(lists, 100u);
  // The middles of the ends have more.
  EXPECT_LT(lists, leaves);
}

TEST(MaskTree, DividesNeedlesLessIfTheyAreInManySectors) {
  SampleMesh mesh = store(degenerate("cylinder-1K", 20000));
  mesh.sort();
  const ClippedGrid grid(mesh.lower());
  const auto cells = [&](std::uint64_t spread) {
    const auto list = [](const GridCell&, MaskBlocks&) { return false; };
    return mask_of_sector(grid, {}, 0, spread, mesh, list).entries.size();
  };
  EXPECT_LT(cells(5), cells(1) / 2);
}

TEST(MaskSectors, SayHowManyOfThemATriangleIsIn) {
  const auto spread = [](const Soup& soup) {
    const SampleMesh mesh = store(soup);
    const auto runs = runs_of(mesh);
    MaskSectors sectors(mesh.lower(), {}, 0, mesh.float64(), 2000, spill_file());
    EXPECT_TRUE(sectors.divide(*runs, nullptr, false, mesh.size() / 4));
    EXPECT_TRUE(sectors.add(mesh));
    return sectors.spread(*runs);
  };
  EXPECT_EQ(spread(sphere(5)), 1u);
  EXPECT_GE(spread(degenerate("double-cone", 8192)), 4u);
}

// An ordinary model of as many triangles has about a cell for three triangles.
TEST(MaskTree, HasFewCellsIfTrianglesAreDegenerate) {
  constexpr std::uint32_t kTriangles = 6000;
  for (const std::string_view kind :
       {"double-cone", "solid-needles", "bars", "coincident-solid", "shells", "segments",
        "short-segments", "one-segment", "points", "cylinder-1K"}) {
    SCOPED_TRACE(std::string(kind));
    const Soup soup = degenerate(kind, kTriangles);
    EXPECT_LT(mask_of(store(soup)).entries.size(), soup.size());
  }
}

// The line through a block's middle crosses copies of its triangle in hundreds of blocks.
TEST(HeightFieldFinder, StopsAtTheSecondTriangleOnTheLine) {
  const HeightFieldModel model(degenerate("coincident-solid", 20000));
  TreeFrames frames(model.tree.tree.get(), &model.mask);
  const HeightFieldFinder finder(model.info, model.mask_info);
  std::size_t blocks = 0, marked = 0;
  TraversalStats work;
  model.each_block([&](const BlockView& block, std::uint32_t) {
    ++blocks;
    marked += finder.is_height_field(block, frames.reader(), work);
  });
  EXPECT_EQ(marked, 0u);
  EXPECT_GT(blocks, 1000u);
  EXPECT_LT(work.blocks, 64 * blocks) << work.blocks;
}

}  // namespace
}  // namespace planetree::octree
