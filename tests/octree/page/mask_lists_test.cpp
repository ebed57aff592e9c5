#include <gtest/gtest.h>

#include <tbb/task_arena.h>

#include <map>
#include <mutex>

#include "octree/builder/mask/block_lister.h"
#include "octree/builder/mask/built_mask.h"
#include "octree/builder/mask/tree_frames.h"
#include "octree/builder/surface/region_cut.h"
#include "octree/geometry/cell_overlap.h"
#include "tests/octree/builder/chunked_tree.h"
#include "tests/octree/page/raw_mask_page.h"
#include "tests/octree/support/sample_mask.h"

// Lists of blocks in the masks of sample models.
namespace planetree::octree {
namespace {

using Kind = MaskEntry::Kind;

/// A watertight model with its tree and a mask that lists the tree's blocks.
struct MaskWithLists {
  explicit MaskWithLists(const Soup& soup, std::uint64_t sector_triangles = 1000)
      : tree(soup, 150),
        mask(mask_of(tree.mesh, sector_triangles, tree.tree.get())),
        surface(tree.mesh),
        grid(tree.mesh.lower()) {}

  Point random_point_in(const GridCell& cell, Noise& noise) const {
    const Point lower = grid.lower(cell), size = grid.upper(cell) - lower;
    const Vec3 share = noise.point(0, 1);
    return lower + size.cwiseProduct(Point(share.x, share.y, share.z));
  }

  ChunkedTree tree;
  MaskTree mask;
  Surface surface;
  ClippedGrid grid;
};

std::vector<Soup> listing_soups() {
  return {sphere(5), joined({sphere(4), inside_out(scaled(sphere(4), 0.8))}),
          translated(grains(400, 0.1), {7, 1.0 / 3, -1e3})};
}

TEST(MaskLists, EmptyOctantsHaveTheirCornersWindingNumber) {
  std::size_t empty = 0, listed = 0;
  for (const Soup& soup : listing_soups()) {
    const MaskWithLists sample(soup);
    Noise noise(3);
    each_entry(sample.mask, [&](const GridCell& cell, std::uint32_t at) {
      const MaskEntry& entry = sample.mask.entries[at];
      if (entry.kind != Kind::kListed || testing::Test::HasFailure()) return;
      ++listed;
      unsigned touched = 0;
      const MaskBlocks& blocks = sample.mask.lists[entry.first];
      for (unsigned i = 0; i < blocks.count; ++i) touched |= blocks.octants[i];
      for (unsigned octant = 0; octant < 8; ++octant) {
        EXPECT_EQ(entry.corners[octant], sample.surface.winding(sample.grid.corner(cell, octant)));
        if ((touched >> octant & 1) != 0) continue;
        ++empty;
        for (int i = 0; i < 3; ++i)
          EXPECT_EQ(sample.surface.winding(sample.random_point_in(cell.child(octant), noise)),
                    entry.corners[octant]);
      }
    });
  }
  EXPECT_GT(listed, 300u);
  EXPECT_GT(empty, 300u);
}

// A leaf has a list exactly if one bit a corner tells its numbers and the tree has few enough
// blocks there.
TEST(MaskLists, MatchTheBlocksOfTheTree) {
  const MaskWithLists sample(sphere(5), 1 << 20);
  const TreeInfo info = sample.tree.tree->info();
  TreeFrames frames(sample.tree.tree.get());
  const BlockLister lister(info, sample.grid);
  std::map<Kind, std::size_t> kinds;
  each_entry(sample.mask, [&](const GridCell& cell, std::uint32_t at) {
    const MaskEntry& entry = sample.mask.entries[at];
    if (entry.kind != Kind::kListed && entry.kind != Kind::kCorners) return;
    ++kinds[entry.kind];
    MaskBlocks blocks;
    const auto outcome = lister.list(cell, frames.reader(), blocks);
    const bool listed = outcome == BlockLister::Outcome::kListed;
    EXPECT_EQ(entry.kind == Kind::kListed, listed);
    if (!listed || entry.kind != Kind::kListed) return;
    EXPECT_GT(blocks.count, 0u);
    const MaskBlocks& held = sample.mask.lists[entry.first];
    blocks.slab = held.slab;  // the lister computes no slab
    EXPECT_TRUE(same(blocks, held));
  });
  EXPECT_GT(kinds[Kind::kListed], 100u);
}

TEST(MaskLists, AreAbsentWhereCornersHaveMoreThanTwoWindingNumbers) {
  const MaskWithLists sample(joined({copies(sphere(3), 2), scaled(sphere(4), 0.5)}));
  std::map<Kind, std::size_t> kinds;
  each_entry(sample.mask, [&](const GridCell&, std::uint32_t at) {
    const MaskEntry& entry = sample.mask.entries[at];
    ++kinds[entry.kind];
    if (entry.kind != Kind::kListed) return;
    const auto [least, greatest] = std::minmax_element(entry.corners.begin(), entry.corners.end());
    EXPECT_LE(*greatest - *least, 1);
  });
  EXPECT_GT(kinds[Kind::kListed], 10u);
  EXPECT_GT(kinds[Kind::kCorners], 10u);
}

// Each sector holds one or two blocks. The cells above the sectors store no list for a sector's
// root.
TEST(MaskLists, AreAbsentAtSectorRoots) {
  const ChunkedTree tree(grains(60, 0.05), 150);
  RegionCut cut(tree.mesh.frame, {}, nullptr);
  ASSERT_TRUE(cut.add(tree.mesh));
  MaskSectors sectors(tree.mesh.lower(), {}, cut.found().winding, true, 1 << 20, spill_file());
  ASSERT_TRUE(sectors.divide(*tree.runs, nullptr, false, 20) && sectors.add(tree.mesh));
  std::mutex mutex;
  std::size_t roots = 0;
  const auto above = build_mask(
      sectors, *tree.runs, tree.tree.get(), [](std::size_t) { return nullptr; },
      [&](std::size_t, const MaskTree& mask, const SectorRoot& root) -> Result<void> {
        const std::lock_guard lock(mutex);
        if (mask.entries[0].kind != Kind::kListed) return {};
        ++roots;
        EXPECT_EQ(root.entry.kind, Kind::kCorners);
        EXPECT_EQ(root.entry.corners, mask.entries[0].corners);
        return {};
      });
  ASSERT_TRUE(above);
  EXPECT_GT(roots, 5u);
  EXPECT_TRUE(above->lists.empty());
  for (const MaskEntry& entry : above->entries) EXPECT_NE(entry.kind, Kind::kListed);
}

// The mask consists of its root alone, in a page of its own.
TEST(MaskLists, ArePresentInAMaskOfOneCell) {
  const ChunkedTree tree(box({0, 0, 0}, {1.75, 1.5, 1.25}));
  RegionCut cut(tree.mesh.frame, {}, nullptr);
  ASSERT_TRUE(cut.add(tree.mesh));
  MaskSectors sectors(tree.mesh.lower(), {}, cut.found().winding, false, 1 << 20, spill_file());
  ASSERT_TRUE(sectors.divide(*tree.runs, nullptr, false) && sectors.add(tree.mesh));
  BuiltMask mask(4096, false, spill_file());
  ASSERT_TRUE(mask.build(sectors, *tree.runs, tree.tree.get(),
                         [](std::uint32_t, const BuiltSector&) { return Result<void>(); }));
  const auto page = mask.encode(0, tree.tree->pages().size());
  ASSERT_TRUE(page);
  const RawMaskPage raw = RawMaskPage::of(page->bytes, false);
  ASSERT_EQ(raw.kinds, std::vector{static_cast<std::uint8_t>(MaskKind::kListed)});
  EXPECT_EQ(raw.least[0], 0);
  EXPECT_EQ(raw.higher[0], 1);
  EXPECT_EQ(raw.block_octants, std::vector<std::uint8_t>{0xff});
  EXPECT_EQ(raw.block_pages, std::vector<std::uint32_t>{0});
  EXPECT_EQ(raw.block_numbers, std::vector<std::uint16_t>{0});
}

TEST(MaskLists, DoNotDependOnThreads) {
  const ChunkedTree tree(joined({sphere(5), translated(sphere(4), {0.7, 0.3, -0.2})}), 150);
  const auto build = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return mask_of(tree.mesh, 500, tree.tree.get()); });
  };
  const MaskTree one = build(1), two = build(2);
  ASSERT_EQ(one.lists.size(), two.lists.size());
  EXPECT_GT(one.lists.size(), 100u);
  for (std::size_t i = 0; i < one.lists.size(); ++i) EXPECT_TRUE(same(one.lists[i], two.lists[i]));
}

// A triangle so close to a cell's corner that the rounded test takes it to touch the cell, but none
// of its octants. An empty list cannot be stored.
TEST(MaskLists, AreNeverEmpty) {
  const CellGrid grid(Point::Zero());
  const GridCell cell = GridCell{}.child(0);
  const auto face = [](double beside) -> Triangle {
    return {Point(1.9, 0.5, 0.6 + beside), Point(0.5, 1.9, 0.6 + beside),
            Point(0.6, 0.5, 1.9 + beside)};
  };
  std::size_t found = 0;
  for (int step = -400; step < 400; ++step) {
    const Triangle near = face(step * 0x1p-52);
    bool octant_touched = false;
    for (unsigned octant = 0; octant < 8; ++octant)
      octant_touched = octant_touched || may_touch(near, grid.lower(cell.child(octant)),
                                                   grid.upper(cell.child(octant)));
    if (octant_touched || !may_touch(near, grid.lower(cell), grid.upper(cell))) continue;
    ++found;
    const auto vec = [](const Point& p) { return Vec3{p.x(), p.y(), p.z()}; };
    const Vec3 a = vec(near[0]), b = vec(near[1]), c = vec(near[2]), d{1.95, 1.95, 1.95};
    const MaskWithLists sample(joined(
        {Soup{{a, c, b}, {a, b, d}, {b, c, d}, {c, a, d}}, box({0, 1.5, 1.5}, {0.1, 1.6, 1.6}, 2),
         box({1.5, 0, 1.5}, {1.6, 0.1, 1.6}, 2), box({1.5, 1.5, 0}, {1.6, 1.6, 0.1}, 2)}));
    ASSERT_EQ(sample.tree.mesh.lower(), Point::Zero());
    for (const MaskBlocks& list : sample.mask.lists) EXPECT_GT(list.count, 0u);
    if (HasFailure()) break;
  }
  EXPECT_GT(found, 0u);
}

}  // namespace
}  // namespace planetree::octree
