#include "octree/mask/mask_lookup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/octree/mask/random_mask.h"
#include "tests/octree/support/sample_mask.h"

namespace planetree::octree {
namespace {

using Kind = MaskEntry::Kind;

/// The path of a point through the mask, as the specification defines it, found in the entries
/// themselves.
struct PathToCell {
  std::vector<std::uint32_t> entries;  ///< from the root to a leaf or the last node
  GridCell cell;
  bool colour = false;
  int winding = 0;
  std::size_t nodes(const MaskTree& tree) const {
    return entries.size() - tree.entries[entries.back()].is_leaf();
  }
};

PathToCell path_of(const MaskTree& tree, const CellGrid& grid, const Point& point) {
  PathToCell path;
  for (std::uint32_t at = 0;;) {
    path.entries.push_back(at);
    const MaskEntry& entry = tree.entries[at];
    if (entry.kind != Kind::kNode) return path;
    const Point middle = grid.middle(path.cell);
    const unsigned octant = (point.x() >= middle.x() ? 1u : 0u) |
                            (point.y() >= middle.y() ? 2u : 0u) |
                            (point.z() >= middle.z() ? 4u : 0u);
    path.cell = path.cell.child(octant);
    if ((entry.grey >> octant & 1) == 0) {
      path.colour = true;
      path.winding = (entry.black >> octant & 1) - (entry.inverted >> octant & 1);
      return path;
    }
    at = entry.first;
    for (unsigned before = 0; before < octant; ++before) at += entry.grey >> before & 1;
  }
}

// Random points, half of them on the sides of cells.
std::vector<Point> points_in(const Point& lower, std::size_t count) {
  Noise noise(8);
  std::vector<Point> points;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = noise.point(0, 2);
    Point point = lower + Point(p.x, p.y, p.z);
    if (i % 2 == 0)
      for (double& value : point) value = std::floor(value * 64) / 64;
    points.push_back(point);
  }
  return points;
}

void expect_same(const MaskLookup& found, const PathToCell& path, const MaskTree& tree) {
  using Found = MaskLookup::Kind;
  EXPECT_EQ(found.cell.level, path.cell.level);
  EXPECT_EQ(found.cell.at, path.cell.at);
  const MaskEntry& entry = tree.entries[path.entries.back()];
  if (path.colour) {
    EXPECT_EQ(found.kind, Found::kColour);
    EXPECT_EQ(found.winding, path.winding);
    EXPECT_EQ(found.blocks.count, 0u);
  } else if (entry.kind == Kind::kSpecial) {
    const SpecialCell& special = tree.specials[entry.first];
    EXPECT_EQ(found.kind, Found::kPlanes);
    EXPECT_TRUE(found.winding == special.behind || found.winding == special.beyond);
  } else if (entry.corners[0] == kUncounted) {
    EXPECT_EQ(found.kind, Found::kNothing);
  } else {
    EXPECT_EQ(found.kind, Found::kCorners);
    const bool listed = entry.kind == Kind::kListed;
    for (unsigned corner = 0; corner < 8; ++corner)
      EXPECT_EQ(listed ? corner_number(found.listed, corner) : found.corners[corner],
                entry.corners[corner]);
    EXPECT_TRUE(same(found.blocks, listed ? tree.lists[entry.first] : MaskBlocks{}));
  }
}

class MaskLookupTest : public testing::Test {
 protected:
  MaskLookupTest() : tree_(random_mask(10)), grid_(lower_), pages_(tree_, 4096, kRandomMaskPage) {}

  MaskLookup find(const Point& point, std::uint64_t max_work = ~std::uint64_t{0}) {
    work_ = {};
    return look_up(pages_.mask(lower_), point, max_work, pages_.reader(), work_);
  }
  std::uint32_t page_of(std::uint32_t entry) const {
    for (std::uint32_t page = 0; page < pages_.size(); ++page)
      if (std::ranges::find(pages_.plan().pages[page].entries, entry) !=
          pages_.plan().pages[page].entries.end())
        return page;
    return ~0u;
  }
  // Pages in the order of the path, each once.
  std::vector<std::uint32_t> pages_of(const PathToCell& path) const {
    std::vector<std::uint32_t> pages;
    for (const std::uint32_t entry : path.entries)
      if (const std::uint32_t page = page_of(entry); pages.empty() || pages.back() != page)
        pages.push_back(page);
    return pages;
  }

  const Point lower_{-0.25, 3, 1.0 / 3};
  MaskTree tree_;
  CellGrid grid_;
  MaskPages pages_;
  TraversalStats work_;
};

TEST_F(MaskLookupTest, FindsTheCellOfEveryPoint) {
  std::size_t listed = 0;
  for (const Point& point : points_in(lower_, 4000)) {
    const PathToCell path = path_of(tree_, grid_, point);
    const MaskLookup found = find(point);
    expect_same(found, path, tree_);
    listed += found.blocks.count > 0;
    EXPECT_EQ(work_.nodes, path.nodes(tree_));
    EXPECT_LE(work_.nodes, tree_.levels);
    EXPECT_EQ(work_.blocks, 0u);
    ASSERT_FALSE(HasFailure()) << point.transpose();
  }
  EXPECT_GT(listed, 100u);
}

TEST_F(MaskLookupTest, AccessesOnlyPagesOnThePath) {
  std::size_t most = 0;
  for (const Point& point : points_in(lower_, 3000)) {
    find(point);
    const std::vector<std::uint32_t> queried = pages_.take_queried();
    ASSERT_EQ(queried, pages_of(path_of(tree_, grid_, point))) << point.transpose();
    EXPECT_TRUE(std::ranges::is_sorted(queried));
    EXPECT_EQ(work_.page_switches, queried.size());
    most = std::max(most, queried.size());
  }
  EXPECT_GT(most, 2u);
}

TEST_F(MaskLookupTest, IsUnknownWhereAPageIsMissing) {
  const std::vector<Point> points = points_in(lower_, 150);
  std::size_t lost = 0;
  for (std::uint32_t page = 0; page < pages_.size(); page += 1 + page / 4) {
    pages_.withhold(page);
    for (const Point& point : points) {
      const PathToCell path = path_of(tree_, grid_, point);
      const std::vector<std::uint32_t> on_path = pages_of(path);
      const auto at = std::ranges::find(on_path, page);
      pages_.take_queried();
      const MaskLookup found = find(point);
      if (at == on_path.end()) {
        expect_same(found, path, tree_);
        continue;
      }
      ++lost;
      EXPECT_EQ(found.kind, MaskLookup::Kind::kNothing);
      EXPECT_EQ(pages_.take_queried(), std::vector(on_path.begin(), at + 1));
    }
    pages_.withhold(page, false);
    ASSERT_FALSE(HasFailure()) << page;
  }
  EXPECT_GT(lost, 100u);
}

TEST_F(MaskLookupTest, StaysWithinMaxWork) {
  for (const Point& point : points_in(lower_, 200)) {
    const PathToCell path = path_of(tree_, grid_, point);
    (void)find(point);
    const std::uint64_t needed = work_.units;
    EXPECT_GE(needed, path.nodes(tree_));
    for (std::uint64_t most = 0; most <= needed; ++most) {
      const MaskLookup found = find(point, most);
      EXPECT_LE(work_.units, most);
      if (most < needed) {
        EXPECT_EQ(found.kind, MaskLookup::Kind::kNothing);
      } else {
        expect_same(found, path, tree_);
      }
    }
  }
}

TEST_F(MaskLookupTest, IsUnknownWithoutAMask) {
  MaskInfo none = pages_.mask(lower_);
  none.page_count = 0;
  EXPECT_EQ(look_up(none, lower_, 100, pages_.reader(), work_).kind, MaskLookup::Kind::kNothing);
  EXPECT_TRUE(pages_.take_queried().empty());
}

// The octants of a finest cell have no octcode, so its list of blocks is not used.
TEST(MaskLookupListsTest, RefusesListsOfFinestCells) {
  MaskTree tree;
  tree.entries.resize(1);
  for (unsigned level = 0; level < kLevels; ++level) {
    const bool last = level + 1 == kLevels;
    MaskEntry& node = tree.entries.back();
    node = {.grey = 1, .leaf = static_cast<std::uint8_t>(last ? 1 : 0)};
    node.first = static_cast<std::uint32_t>(tree.entries.size());
    tree.entries.emplace_back();
  }
  tree.entries.back().kind = Kind::kListed;
  tree.entries.back().corners = {4, 5, 5, 4, 4, 4, 4, 5};
  tree.lists.push_back({1, {0xff}, {LinkFormat::kLeafBit}, {}});
  MaskPages pages(tree, 4096, kRandomMaskPage);
  TraversalStats work;
  const MaskLookup found =
      look_up(pages.mask(Point::Zero()), Point::Zero(), 100, pages.reader(), work);
  EXPECT_EQ(found.cell.level, kLevels);
  EXPECT_EQ(found.kind, MaskLookup::Kind::kNothing);
  EXPECT_EQ(found.blocks.count, 0u);
}

// The decoder cannot check what a node's link to another page leads to.
TEST_F(MaskLookupTest, ChecksLinksBetweenPages) {
  const MaskLinkFormat links(4096);
  std::size_t changed = 0;
  for (std::uint32_t page = 0; page < pages_.size(); ++page) {
    const MaskHeader& head = header_of(pages_.frame(page));
    for (std::uint32_t slot = head.first_record_slot;
         slot < std::uint32_t{head.first_record_slot} + head.record_count; ++slot) {
      if (!is_node(pages_.frame(page), slot)) continue;
      auto& node = *const_cast<MaskNode*>(
          reinterpret_cast<const MaskNode*>(slot_of(pages_.frame(page), slot)));
      if (node.grey == 0 || links.page(node.family()) == page) continue;
      const std::uint32_t below = links.page(node.family());
      // Slots beyond the records, before them, and of another record.
      const std::uint32_t slots[] = {511, 0, links.slot(node.family()) ^ 8};
      node.set_family(links.make(below, slots[changed++ % 3]));
    }
  }
  ASSERT_GT(changed, 30u);
  for (const Point& point : points_in(lower_, 2000)) {
    const MaskLookup found = find(point);
    EXPECT_LE(work_.nodes, kLevels);
    EXPECT_TRUE(found.kind != MaskLookup::Kind::kCorners || found.corners[0] != kUncounted);
  }
}

// The side by the planes, with and without an infinitesimal step.
TEST(MaskLookupBoxesTest, DecidesTheSideInSpecialCells) {
  const SampleMask sample(box({0, 0, 0}, {0.9, 0.8, 0.7}, 24));
  MaskPages pages(sample.tree, 4096);
  std::map<MaskLookup::Kind, int> kinds;
  int on_surface = 0;
  Noise noise(2);
  for (int i = 0; i < 600; ++i) {
    Point point(noise.uniform(0, 0.9), noise.uniform(0, 0.8), noise.uniform(0, 0.7));
    // Near a face or on it.
    const unsigned axis = noise.bits() % 3;
    const double face = noise.bits() % 2 == 0 ? 0.0 : sample.mesh.upper()[axis];
    point[axis] = i % 3 == 0 ? face : face + noise.uniform(-0.05, 0.05);
    TraversalStats work;
    const MaskLookup found =
        look_up(pages.mask(sample.mesh.lower()), point.cwiseMax(sample.mesh.lower()), 100,
                pages.reader(), work);
    point = point.cwiseMax(sample.mesh.lower());
    ++kinds[found.kind];
    if (found.kind != MaskLookup::Kind::kPlanes) continue;
    EXPECT_EQ(found.on_surface, sample.surface.holds(point)) << point.transpose();
    EXPECT_EQ(found.winding, sample.surface.winding(point)) << point.transpose();
    on_surface += found.on_surface;
  }
  EXPECT_GT(kinds[MaskLookup::Kind::kPlanes], 100);
  EXPECT_GT(on_surface, 50);
}

}  // namespace
}  // namespace planetree::octree
