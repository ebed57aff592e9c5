#include "octree/builder/mask/block_lister.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <vector>

#include "octree/geometry/cell_overlap.h"
#include "tests/octree/support/degenerate_meshes.h"
#include "tests/octree/support/each_block.h"
#include "tests/octree/support/each_target.h"
#include "tests/octree/support/sample_mask.h"

namespace planetree::octree {
namespace {

using Listing = BlockLister::Outcome;
// The octants listed for each block, by the block's link.
using Lists = std::map<std::uint32_t, unsigned>;

/// A model with the lister's result and the expected one, found block by block.
struct Lister {
  explicit Lister(const Soup& soup)
      : sample(build_sample(soup)),
        pages(sample),
        tree(tree_info(sample)),
        grid(sample.mesh.lower()) {}
  void clip(const Point& lower, const Point& upper) {
    grid = ClippedGrid(sample.mesh.lower(),
                       Region(lower, upper, sample.mesh.lower(), sample.mesh.upper()));
  }

  Listing list(const GridCell& cell, MaskBlocks& blocks) {
    return BlockLister(tree, grid).list(cell, pages.reader(), blocks);
  }

  // Blocks that may touch octants grown by `larger` on each side.
  Lists one_by_one(const GridCell& cell, double larger) const {
    Lists lists;
    const Point more = Point::Constant(larger);
    const Point least = grid.lower(cell) - more, greatest = grid.upper(cell) + more;
    each_block(sample, pages, [&](const BlockView& block, std::uint32_t link) {
      Point lowest = block.vertex(0), highest = lowest;
      for (unsigned i = 1; i < block.header().vertex_count(); ++i) {
        lowest = lowest.cwiseMin(block.vertex(i));
        highest = highest.cwiseMax(block.vertex(i));
      }
      if ((lowest.array() > greatest.array()).any() || (highest.array() < least.array()).any())
        return;
      for (unsigned octant = 0; octant < 8; ++octant) {
        const Point lower = grid.lower(cell.child(octant)) - more;
        const Point upper = grid.upper(cell.child(octant)) + more;
        for (unsigned i = 0; i < block.triangle_count(); ++i)
          if (may_touch(block.triangle(i), lower, upper)) lists[link] |= 1U << octant;
      }
    });
    return lists;
  }

  // Cells at the surface, from small to large.
  std::vector<GridCell> cells(std::size_t count) const {
    Noise noise(3);
    std::vector<GridCell> found;
    while (found.size() < count) {
      const Point corner = sample.mesh.corners(noise.bits() % sample.mesh.size())[1];
      const GridCell finest = CellGrid(sample.mesh.lower()).finest(corner);
      const GridCell cell = finest.ancestor(1 + noise.bits() % 8);
      if (grid.has_part_of(cell)) found.push_back(cell);
    }
    return found;
  }

  SampleTree sample;
  SamplePages pages;
  TreeInfo tree;
  ClippedGrid grid;
};

// Expects each list to hold all blocks that may touch, and of others only those within `rounding`.
// Returns the number of lists.
std::size_t expect_as_one_by_one(Lister& lister, double rounding) {
  std::size_t lists = 0;
  for (const GridCell& cell : lister.cells(100)) {
    const Lists least = lister.one_by_one(cell, 0), most = lister.one_by_one(cell, rounding);
    MaskBlocks blocks;
    const Listing outcome = lister.list(cell, blocks);
    if (outcome != Listing::kListed) {
      EXPECT_EQ(outcome, Listing::kTooMany);
      EXPECT_GT(most.size(), kMaxListed);
      continue;
    }
    ++lists;
    EXPECT_LE(blocks.count, kMaxListed);
    Lists found;
    for (unsigned i = 0; i < blocks.count; ++i) {
      EXPECT_TRUE(i == 0 || blocks.links[i - 1] < blocks.links[i]);
      found[blocks.links[i]] = blocks.octants[i];
      EXPECT_TRUE(most.contains(blocks.links[i]));
      if (most.contains(blocks.links[i])) {
        EXPECT_EQ(blocks.octants[i] & ~most.at(blocks.links[i]), 0u);
      }
    }
    for (const auto& [link, octants] : least) EXPECT_EQ(octants & ~found[link], 0u);
    if (testing::Test::HasFailure()) break;
  }
  return lists;
}

// The sides of these cells are floats.
TEST(BlockLister, ListsBlocksThatMayTouchAnOctant) {
  Lister lister(sphere(5));
  EXPECT_GT(expect_as_one_by_one(lister, 0), 40u);
}

TEST(BlockLister, MissesNoBlockWhereSidesAreNotFloats) {
  Lister lister(translated(sphere(5), {0x1.234567p-3, 0x1.abcdefp3, -0x1.3579bdp-5}));
  EXPECT_GT(expect_as_one_by_one(lister, 0x1p-18), 40u);
}

TEST(BlockLister, ListsExactlyWhereVerticesAreDoubles) {
  Lister lister(scattered(3000, 0.05));
  EXPECT_GT(expect_as_one_by_one(lister, 0), 40u);
}

TEST(BlockLister, ListsWithinTheWallsOfARegion) {
  Lister lister(sphere(5));
  lister.clip({-0.3, -2, 0.123}, {2, 0.7, 2});
  EXPECT_GT(expect_as_one_by_one(lister, 0x1p-22), 40u);
}

// Clips the root to boxes that grow about a vertex.
TEST(BlockLister, ListsNoMoreThanMaxListed) {
  Lister lister(sphere(5));
  std::set<std::size_t> listed, too_many;
  Noise noise(8);
  for (int i = 0; i < 20; ++i) {
    const Point middle = lister.sample.mesh.corners(noise.bits() % lister.sample.mesh.size())[0];
    for (double half = 0.01; half < 1; half *= 1.02) {
      lister.clip(middle - Point::Constant(half), middle + Point::Constant(half));
      MaskBlocks blocks;
      const Listing listing = lister.list({}, blocks);
      if (listing == Listing::kListed) {
        listed.insert(blocks.count);
        continue;
      }
      EXPECT_EQ(listing, Listing::kTooMany);
      too_many.insert(lister.one_by_one({}, 0).size());
      break;
    }
  }
  EXPECT_TRUE(listed.contains(kMaxListed));
  EXPECT_LE(*listed.rbegin(), kMaxListed);
  EXPECT_TRUE(too_many.contains(kMaxListed + 1));
  EXPECT_GT(*too_many.begin(), kMaxListed);
}

// Boxes of needles meet cells that the needles pass by far away.
TEST(BlockLister, GivesUpWhereTheBoxesOfManyBlocksMeetTheCell) {
  Lister lister(degenerate_kind("solid-needles")->make(40000).soup());
  std::size_t few_touch = 0;
  for (const GridCell& cell : lister.cells(60)) {
    MaskBlocks blocks;
    if (lister.list(cell, blocks) == Listing::kListed) continue;
    few_touch += lister.one_by_one(cell, 0).size() <= kMaxListed;
  }
  EXPECT_GT(few_touch, 5u);
}

TEST(BlockLister, IsLostWhereAPageIsMissing) {
  Lister lister(sphere(5));
  ASSERT_GT(lister.pages.size(), 4u);
  MaskBlocks blocks;
  std::vector<GridCell> lost, kept;
  const std::uint32_t taken = static_cast<std::uint32_t>(lister.pages.size()) / 2;
  for (const GridCell& cell : lister.cells(400)) {
    if (lister.list(cell, blocks) != Listing::kListed) continue;
    bool in_taken = false;
    for (unsigned i = 0; i < blocks.count; ++i)
      in_taken = in_taken || LinkFormat::numbered(4096).page(blocks.links[i]) == taken;
    (in_taken ? lost : kept).push_back(cell);
  }
  lister.pages.withhold(taken);
  EXPECT_FALSE(lost.empty());
  for (const GridCell& cell : lost) EXPECT_EQ(lister.list(cell, blocks), Listing::kLost);
  std::size_t listed = 0;
  for (const GridCell& cell : kept) listed += lister.list(cell, blocks) == Listing::kListed;
  EXPECT_GT(listed, kept.size() / 2);
  lister.pages.withhold(0);
  for (const GridCell& cell : kept) EXPECT_EQ(lister.list(cell, blocks), Listing::kLost);
}

// The file's bytes depend on the lists.
TEST(BlockLister, ListsTheSameOnEveryInstructionSet) {
  for (const Soup& soup : {translated(sphere(5), {0.1f, 3.7f, -0.3f}), scattered(2000, 0.05)}) {
    Lister lister(soup);
    const std::vector<GridCell> cells = lister.cells(120);
    const auto results = on_each_target([&] {
      std::vector<std::uint32_t> bits;
      for (const GridCell& cell : cells) {
        MaskBlocks blocks;
        bits.push_back(static_cast<std::uint32_t>(lister.list(cell, blocks)));
        if (bits.back() != static_cast<std::uint32_t>(Listing::kListed)) continue;
        for (unsigned i = 0; i < blocks.count; ++i)
          bits.insert(bits.end(), {blocks.links[i], blocks.octants[i]});
      }
      return bits;
    });
    ASSERT_FALSE(results.empty());
    for (const auto& bits : results) EXPECT_EQ(bits == results[0], true);
  }
}

}  // namespace
}  // namespace planetree::octree
