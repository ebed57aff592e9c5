#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "octree/builder/mask/block_lister.h"
#include "octree/winding/crossings.h"
#include "tests/octree/support/each_target.h"
#include "tests/octree/support/sample_mask.h"

// Compares crossings counted in listed blocks with those counted in the whole tree.
namespace planetree::octree {
namespace {

constexpr std::uint64_t kAnyWork = ~std::uint64_t{0};

/// Octants of cells of a closed surface, with the blocks listed for each.
struct ListedOctants {
  struct Octant {
    Point lower, upper;
    std::vector<std::uint32_t> blocks;
  };

  explicit ListedOctants(const Soup& soup)
      : sample(build_sample(soup)), pages(sample), tree(tree_info(sample)) {
    const ClippedGrid grid(sample.mesh.lower());
    const BlockLister lister(tree, grid);
    Noise noise(4);
    while (octants.size() < 300) {
      const Point at = sample.mesh.corners(noise.bits() % sample.mesh.size())[0];
      const GridCell cell = CellGrid(sample.mesh.lower()).finest(at).ancestor(2 + noise.bits() % 7);
      MaskBlocks list;
      if (lister.list(cell, pages.reader(), list) != BlockLister::Outcome::kListed) continue;
      const unsigned octant = noise.bits() % 8;
      const GridCell child = cell.child(octant);
      octants.push_back({grid.lower(child), grid.upper(child), {}});
      for (unsigned i = 0; i < list.count; ++i)
        if ((list.octants[i] >> octant & 1) != 0) octants.back().blocks.push_back(list.links[i]);
    }
  }

  Crossings count(const PerturbedSegment& segment, const std::vector<std::uint32_t>& blocks,
                  std::uint64_t max_work = kAnyWork) {
    work = {};
    return count_crossings(tree, segment, blocks, max_work, pages.reader(), work);
  }
  // The first octant with at least `blocks` blocks: a segment from its middle to its lower corner,
  // and its blocks.
  std::pair<PerturbedSegment, std::vector<std::uint32_t>> one_of(std::size_t blocks) const {
    const auto at = std::ranges::find_if(
        octants, [&](const Octant& octant) { return octant.blocks.size() >= blocks; });
    if (at == octants.end()) return {};
    return {{(at->lower + at->upper) / 2, at->lower}, at->blocks};
  }

  SampleTree sample;
  SamplePages pages;
  TreeInfo tree;
  TraversalStats work;
  std::vector<Octant> octants;
};

// Random segments within an octant or on its sides. Two end at a corner.
std::vector<PerturbedSegment> segments_in(const ListedOctants::Octant& octant, Noise& noise) {
  const auto point = [&](unsigned rounding) {
    Point p;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const double share = noise.uniform(0, 1);
      const bool at_side = noise.bits() % 4 < rounding;
      p[axis] = octant.lower[axis] +
                (at_side ? std::round(share) : share) * (octant.upper[axis] - octant.lower[axis]);
    }
    return p;
  };
  return {{point(0), point(4)}, {point(1), point(4)}, {point(1), point(0)}};
}

std::size_t expect_as_in_the_tree(const Soup& soup) {
  ListedOctants listed(soup);
  Noise noise(6);
  std::size_t crossed = 0;
  for (const ListedOctants::Octant& octant : listed.octants) {
    std::vector<PerturbedSegment> segments = segments_in(octant, noise);
    // A segment that starts at a vertex in the octant, thus on the surface.
    for (std::uint32_t i = 0; i < listed.sample.mesh.size(); ++i) {
      const Point vertex = listed.sample.mesh.corners(i)[0];
      if ((vertex.array() < octant.lower.array()).any() ||
          (vertex.array() > octant.upper.array()).any())
        continue;
      segments.push_back({vertex, octant.upper});
      break;
    }
    for (const PerturbedSegment& segment : segments) {
      const Crossings found = listed.count(segment, octant.blocks);
      EXPECT_EQ(listed.work.blocks, octant.blocks.size());
      EXPECT_EQ(listed.work.nodes, 0u);
      TraversalStats work;
      const Crossings expected =
          count_crossings(listed.tree, segment, kAnyWork, listed.pages.reader(), work);
      EXPECT_TRUE(found.complete);
      EXPECT_EQ(found.difference, expected.difference);
      EXPECT_EQ(found.on_surface, expected.on_surface);
      crossed += expected.difference != 0;
    }
    if (testing::Test::HasFailure()) break;
  }
  return crossed;
}

TEST(CrossingsInBlocks, MatchTheTreeWithinAnOctant) {
  EXPECT_GT(expect_as_in_the_tree(sphere(5)), 50u);
  EXPECT_GT(expect_as_in_the_tree(translated(sphere(4), {1e3, 1.0 / 3, -7})), 50u);
  EXPECT_GT(expect_as_in_the_tree(grains(300, 0.1)), 10u);
}

TEST(CrossingsInBlocks, AreIncompleteWhereWorkEnds) {
  ListedOctants listed(sphere(5));
  const auto [segment, blocks] = listed.one_of(3);
  ASSERT_GE(blocks.size(), 3u);
  EXPECT_TRUE(listed.count(segment, blocks).complete);
  const std::uint64_t needed = listed.work.units;
  EXPECT_GT(needed, blocks.size());
  EXPECT_TRUE(listed.count(segment, blocks, needed).complete);
  EXPECT_FALSE(listed.count(segment, blocks, needed - 1).complete);
  EXPECT_FALSE(listed.count(segment, blocks, blocks.size() - 1).complete);
  EXPECT_LT(listed.work.blocks, blocks.size());
  EXPECT_FALSE(listed.count(segment, blocks, 0).complete);
  EXPECT_TRUE(listed.count(segment, {}, 0).complete);
}

TEST(CrossingsInBlocks, AreIncompleteWithoutAPage) {
  ListedOctants listed(sphere(5));
  const auto [segment, blocks] = listed.one_of(2);
  ASSERT_GE(blocks.size(), 2u);
  listed.pages.withhold(LinkFormat::numbered(4096).page(blocks[0]));
  EXPECT_FALSE(listed.count(segment, blocks).complete);
}

// Tests each position in the list.
TEST(CrossingsInBlocks, AreIncompleteWhereALinkLeadsToNoBlock) {
  ListedOctants listed(sphere(5));
  const auto [segment, blocks] = listed.one_of(2);
  ASSERT_GE(blocks.size(), 2u);
  const LinkFormat links = LinkFormat::numbered(4096);
  const std::uint32_t page = links.page(blocks[0]);
  const std::uint16_t count = listed.pages.frame(page).header().block_count;
  for (const std::uint32_t wrong :
       {listed.tree.root_link, blocks[0] & ~LinkFormat::kLeafBit, links.make_block({page, count}),
        links.make_block({page, 15}),
        links.make_block({static_cast<std::uint32_t>(listed.pages.size()), 0}), 0xffffffffu})
    for (std::size_t at = 0; at < blocks.size(); ++at) {
      std::vector<std::uint32_t> changed = blocks;
      changed[at] = wrong;
      EXPECT_FALSE(listed.count(segment, changed).complete) << std::hex << wrong;
    }
}

TEST(CrossingsInBlocks, AreTheSameOnEveryInstructionSet) {
  ListedOctants listed(translated(sphere(5), {0.1f, 3.7f, -0.3f}));
  const auto results = on_each_target([&] {
    std::vector<std::int64_t> numbers;
    Noise noise(9);
    for (const ListedOctants::Octant& octant : listed.octants)
      for (const PerturbedSegment& segment : segments_in(octant, noise))
        numbers.push_back(listed.count(segment, octant.blocks).difference);
    return numbers;
  });
  ASSERT_FALSE(results.empty());
  for (const auto& numbers : results) EXPECT_EQ(numbers == results[0], true);
}

}  // namespace
}  // namespace planetree::octree
