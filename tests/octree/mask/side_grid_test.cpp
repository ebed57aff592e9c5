#include "octree/mask/side_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "tests/octree/mask/random_side_grid.h"

namespace planetree::octree {
namespace {

using SideGridTest = RandomSideGrid;

TEST_F(SideGridTest, AgreesWithTheMask) {
  for (const std::uint32_t page_bytes : {4096u, 65536u}) {
    MaskPages pages(random_mask(10), page_bytes, kRandomMaskPage);
    for (const std::size_t bytes : {std::size_t{1024}, std::size_t{5000}, kMany}) {
      const SideGrid grid = grid_of(pages, bytes);
      std::size_t known = 0;
      for (const Point& point : points(4000)) {
        const int winding = grid.look(point).winding;
        if (winding == SideGrid::kUnknown) continue;
        ++known;
        ASSERT_EQ(winding, sign_by_mask(pages, lower_, point)) << point.transpose();
      }
      EXPECT_GT(known, 0u) << bytes;
    }
  }
}

TEST_F(SideGridTest, KnowsAllColoursTwoLevelsBelowItsCells) {
  MaskPages pages(random_mask(6), 1 << 20, kRandomMaskPage);
  ASSERT_EQ(pages.size(), 1u);
  // Memory for the cells of level 4.
  const SideGrid grid = grid_of(pages, 240000);
  std::size_t known = 0;
  std::set<int> unknown;
  const std::vector<Point> all = points(4000);
  for (std::size_t i = 1; i < all.size(); i += 2) {  // not on cell sides
    const Point& point = all[i];
    const auto winding = sign_by_mask(pages, lower_, point);
    if (!winding || has_rare_corners(look(pages, point))) continue;
    ++known;
    if (grid.look(point).winding == SideGrid::kUnknown)
      unknown.insert(*winding);
    else
      ASSERT_EQ(grid.look(point).winding, *winding) << point.transpose();
  }
  EXPECT_GT(known, 500u);
  // Only insides of one sign are unknown to the grid: few models have both signs.
  EXPECT_EQ(unknown.size(), 1u);
  EXPECT_EQ(unknown.count(0), 0u);
}

TEST_F(SideGridTest, LimitsPageAccessesOfTheFill) {
  MaskPages pages(random_mask(10), 4096, kRandomMaskPage);
  ASSERT_GT(pages.size(), 2u);
  grid_of(pages, pages.reader(), kMany);
  const std::vector<std::uint32_t> queried = pages.take_queried();
  EXPECT_EQ(queried.front(), 0u);
  EXPECT_GT(std::set<std::uint32_t>(queried.begin(), queried.end()).size(), 2u);
  EXPECT_LE(queried.size(), 1u << 15);
}

TEST_F(SideGridTest, IsUnknownWithoutTheFirstPage) {
  MaskPages pages(random_mask(10), 4096, kRandomMaskPage);
  pages.withhold(0);
  const SideGrid grid = grid_of(pages, kMany);
  for (const Point& point : points(100)) EXPECT_EQ(grid.look(point).winding, SideGrid::kUnknown);
}

TEST_F(SideGridTest, AgreesWithTheMaskWithMissingPages) {
  const MaskTree mask = random_mask(10);
  MaskPages whole(mask, 4096, kRandomMaskPage);
  const std::uint32_t count = whole.mask(lower_).page_count;
  ASSERT_GT(count, 10u);
  for (std::uint32_t page = 1; page < count; page += 3) {
    MaskPages pages(mask, 4096, kRandomMaskPage);
    pages.withhold(page);
    const SideGrid grid = grid_of(pages, 1 << 18);
    for (const Point& point : points(100)) {
      const int winding = grid.look(point).winding;
      if (winding != SideGrid::kUnknown) {
        ASSERT_EQ(winding, sign_by_mask(whole, lower_, point)) << page;
      }
    }
  }
}

TEST_F(SideGridTest, IsOutsideAroundItsCells) {
  MaskPages pages(random_mask(10), 4096, kRandomMaskPage);
  const SideGrid grid = grid_of(pages, kMany);
  for (unsigned axis = 0; axis < 3; ++axis)
    for (const double off : {-1e-6, 2.0, 1e6, -1e6}) {
      Point point = lower_ + size_ / 2;
      point[axis] = lower_[axis] + off;
      EXPECT_EQ(grid.look(point).winding, 0) << axis << " " << off;
      EXPECT_EQ(grid.look(point).record, nullptr);
    }
  // Beyond the range of fixed-point coordinates nothing is known.
  for (const double far : {1e300, -1e300})
    EXPECT_EQ(grid.look(lower_ + Point::Constant(far)).winding, SideGrid::kUnknown) << far;
  // So close to a cell face that rounding may choose another cell: outside or unknown, and no
  // record.
  const Point beside = lower_ - Point::Constant(1e-9);
  EXPECT_NE(std::abs(grid.look(beside).winding), 1);
  EXPECT_EQ(grid.look(beside).record, nullptr);
}

// Octants of cells at a region's wall are not half as long as their cell.
TEST_F(SideGridTest, KnowsOnlyColoursWhereCellsAreClipped) {
  MaskPages pages(random_mask(6), 1 << 20, kRandomMaskPage);
  SideGrid grid;
  memory_.resize(kMany);
  grid.fill(pages.mask(lower_), tree_of(lower_, size_), CapGrid(), true, 0, pages.reader(),
            memory_);
  std::size_t known = 0;
  for (const Point& point : points(4000)) {
    const int winding = grid.look(point).winding;
    if (winding == SideGrid::kUnknown) continue;
    ++known;
    const MaskLookup found = look(pages, point);
    ASSERT_EQ(found.kind, MaskLookup::Kind::kColour);
    ASSERT_EQ(found.winding, winding);
  }
  EXPECT_GT(known, 500u);
}

TEST_F(SideGridTest, IsUnknownUnlessFilled) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const double at : {0.0, -1e300, 1e300, kNaN}) {
    EXPECT_EQ(SideGrid().look(Point::Constant(at)).winding, SideGrid::kUnknown) << at;
    EXPECT_EQ(SideGrid().look(Point::Constant(at)).record, nullptr);
  }
}

// On a face between two cells, or one ulp from it, rounding decides which cell a point is in: the
// grid agrees with the mask or is silent. Far from the origin ulps are large.
TEST_F(SideGridTest, AgreesWithTheMaskNearCellFaces) {
  MaskPages pages(random_mask(10), 65536, kRandomMaskPage);
  for (const double far : {1.0 / 3, 1e6 + 1.0 / 3, 1e12}) {
    const Point lower = lower_ + Point::Constant(far);
    SideGrid grid;
    memory_.resize(kMany);
    grid.fill(pages.mask(lower), tree_of(lower, size_), CapGrid(), false, 0, pages.reader(),
              memory_);
    Noise noise(11);
    std::size_t known = 0;
    for (unsigned i = 0; i < 6000; ++i) {
      const Vec3 p = noise.point(0, 1);
      Point step = Point(p.x, p.y, p.z).cwiseProduct(size_);
      const unsigned axis = i % 3;
      step[axis] = std::floor(step[axis] * 64) / 64;
      Point point = lower + step;
      if (i % 2 != 0) point[axis] = std::nextafter(point[axis], i % 4 == 1 ? -1e300 : 1e300);
      if ((point.array() < lower.array()).any()) continue;
      const int winding = grid.look(point).winding;
      if (winding == SideGrid::kUnknown) continue;
      ++known;
      ASSERT_EQ(winding, sign_by_mask(pages, lower, point)) << point.transpose();
    }
    // Farther away, coordinates exceed the range of fixed-point numbers.
    EXPECT_TRUE(known > 200 || far > 1e8) << far;
  }
}

TEST_F(SideGridTest, RefusesBoxesThatDoNotFitTheRoot) {
  MaskPages pages(random_mask(10), 4096, kRandomMaskPage);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double side : {2.1, -0.1, 8589934591.0, 1e300, kInfinity, kInfinity - kInfinity}) {
    SideGrid grid;
    memory_.resize(kMany);
    grid.fill(pages.mask(lower_), tree_of(lower_, {side, 1, 1}), CapGrid(), false, 0,
              pages.reader(), memory_);
    EXPECT_EQ(grid.look(lower_ + size_ / 2).winding, SideGrid::kUnknown) << side;
  }
  EXPECT_TRUE(pages.take_queried().empty());
}

// A lookup gives the same result whether it starts at the root or at a record of the grid.
TEST_F(SideGridTest, FindsTheSameCellWithFewerPages) {
  for (const std::uint32_t page_bytes : {4096u, 65536u}) {
    MaskPages pages(random_mask(10), page_bytes, kRandomMaskPage);
    TraversalStats from_root, from_grid;
    std::size_t leaves = 0;
    for (const std::size_t bytes : {std::size_t{1024}, std::size_t{50000}, kMany}) {
      const SideGrid grid = grid_of(pages, bytes);
      for (const Point& point : points(4000)) {
        const MaskInfo mask = pages.mask(lower_);
        const SideGrid::Lookup lookup = grid.look(point);
        if (lookup.winding != SideGrid::kUnknown) continue;
        const MaskLookup expected = look_up(mask, point, 100, pages.reader(), from_root);
        const std::uint64_t turns = from_grid.page_switches;
        const MaskLookup found = look_up(mask, lookup, point, 100, pages.reader(), from_grid);
        if (lookup.record && !lookup.record->is_node()) {
          ++leaves;
          ASSERT_LE(from_grid.page_switches, turns + 1);
        }
        ASSERT_EQ(found.kind, expected.kind) << point.transpose();
        ASSERT_EQ(found.winding, expected.winding);
        ASSERT_EQ(found.on_surface, expected.on_surface);
        ASSERT_EQ(found.corners, expected.corners);
        for (unsigned corner = 0; found.blocks.count > 0 && corner < 8; ++corner)
          ASSERT_EQ(corner_number(found.listed, corner), corner_number(expected.listed, corner));
        ASSERT_TRUE(same(found.blocks, expected.blocks));
        ASSERT_EQ(found.cell.level, expected.cell.level);
        ASSERT_EQ(found.cell.at, expected.cell.at);
      }
    }
    EXPECT_GT(leaves, 500u);
    EXPECT_LT(from_grid.page_switches, from_root.page_switches);
    EXPECT_LT(from_grid.nodes, from_root.nodes * 3 / 4);
  }
}

// The memory is an allocation of exactly its size, so that sanitizers report a write beyond. The
// pages change between accesses, as if the file had been replaced.
TEST_F(SideGridTest, StaysInItsMemoryWhilePagesChange) {
  MaskPages one(random_mask(10), 4096, kRandomMaskPage);
  MaskPages other(random_mask(10, 2), 4096, kRandomMaskPage);
  struct Exchanged {
    PageReader pages[2];
    std::uint32_t pages_of_both, period, queried = 0;
  };
  std::size_t known = 0;
  for (const std::size_t bytes : {1024u, 5008u, 20000u, 100000u, 1000000u})
    for (const std::uint32_t period : {1u, 7u, 100u, 1000u, 10000u}) {
      Exchanged exchanged{{one.reader(), other.reader()}, 0, period};
      exchanged.pages_of_both = kRandomMaskPage + std::min(one.size(), other.size());
      const PageReader reader{
          &exchanged, [](void* context, std::uint32_t number) noexcept {
            auto& self = *static_cast<Exchanged*>(context);
            const PageReader& now = self.pages[self.queried++ / self.period % 2];
            return number < self.pages_of_both ? now.page(now.context, number) : nullptr;
          }};
      const std::unique_ptr<std::byte[]> memory(new std::byte[bytes]);
      SideGrid grid;
      grid.fill(one.mask(lower_), tree_of(lower_, size_), CapGrid(), false, 0, reader,
                {memory.get(), bytes});
      for (const Point& point : points(500))
        known += grid.look(point).winding != SideGrid::kUnknown;
    }
  EXPECT_GT(known, 1000u);
}

TEST_F(SideGridTest, MemorySizeIsBounded) {
  EXPECT_EQ(SideGrid::bytes(1), 1024u);
  EXPECT_EQ(SideGrid::bytes(4003), 6004u);
  EXPECT_EQ(SideGrid::bytes(~std::uint64_t{0} / 2), 3u << 19);
}

}  // namespace
}  // namespace planetree::octree
