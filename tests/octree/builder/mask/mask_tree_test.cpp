#include "octree/builder/mask/mask_tree.h"

#include <gtest/gtest.h>

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "octree/geometry/predicates.h"
#include "tests/octree/support/degenerate_meshes.h"
#include "tests/octree/support/sample_mask.h"

namespace planetree::octree {
namespace {

using Kind = MaskEntry::Kind;

struct Case {
  const char* name;
  Soup soup;
};

Soup doubled_height_field(unsigned side) {
  return joined({height_field(side), inside_out(height_field(side))});
}

// Vertices, edges and faces on cell borders, and at the box's greatest corner, which cells share.
Soup on_cell_corners() {
  return joined({box({0, 0, 0}, {1, 1, 1}, 8), box({0.25, 0.25, 0.25}, {0.5, 0.75, 1}, 4),
                 inside_out(box({0.5, 0.5, 0}, {1, 0.75, 0.25}, 4))});
}

std::vector<Case> cases() {
  const Vec3 low{-1, -1, -1}, high{1, 1, 1};
  return {
      {"sphere", sphere(3)},
      {"nested", joined({sphere(3), inside_out(scaled(sphere(2), 0.5)), scaled(sphere(2), 0.25)})},
      {"doubled", copies(sphere(2), 2)},
      {"overlapping", joined({sphere(3), translated(sphere(2), {0.7, 0.3, -0.2})})},
      {"inside out", inside_out(sphere(3))},
      {"both ways round", joined({sphere(3), inside_out(translated(sphere(3), {1.5, 0, 0}))})},
      {"on cell corners", on_cell_corners()},
      {"box", box(low, high, 8)},
      {"boxes in boxes",
       joined({box(low, high, 6), inside_out(box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, 4)),
               copies(box({0.5, -1, -1}, {1, 1, 1}, 4), 2)})},
      {"fine box", joined({box({0, 0, 0}, {0.9, 0.8, 0.7}, 24), inside_out(sphere(1))})},
      {"flat", joined({box({0, 0, 0}, {1, 1, 0}, 12)})},
      {"zero thickness", doubled_height_field(12)},
      {"pair of triangles", joined({repeated(1), inside_out(repeated(1))})},
      {"grains", grains(150, 0.3)},
      {"far away", translated(scaled(sphere(3), 0x1p-10), {0x1p20, -0x1p20, 3})},
      {"farther away", translated(box({0, 0, 0}, {8, 8, 8}, 8), {0x1p50, 0x1p52, -0x1p51})},
  };
}

std::array<Point, 8> corners_of(const CellGrid& grid, const GridCell& cell) {
  std::array<Point, 8> corners;
  for (unsigned i = 0; i < 8; ++i) corners[i] = grid.corner(cell, i);
  return corners;
}

/// Winding numbers at corners of cells, computed once for each corner.
class Corners {
 public:
  explicit Corners(const SampleMask& sample) : sample_(sample) {}

  std::int64_t at(const GridCell& cell, unsigned corner) {
    const Point point = sample_.grid.corner(cell, corner);
    const auto [index, added] = known_.try_emplace({point.x(), point.y(), point.z()});
    if (added) index->second = sample_.surface.winding(point);
    return index->second;
  }

 private:
  const SampleMask& sample_;
  std::map<std::array<double, 3>, std::int64_t> known_;
};

std::vector<Triangle> touching(const SampleMask& sample, const GridCell& cell) {
  return sample.surface.touching(sample.grid.lower(cell), sample.grid.upper(cell));
}

struct Found {
  std::size_t coloured_cells = 0, corners = 0, specials = 0;
};

// Compares everything the mask states with all triangles.
Found expect_truth(const SampleMask& sample) {
  Found found;
  Corners corners(sample);
  each_entry(sample.tree, [&](const GridCell& cell, std::uint32_t at) {
    const MaskEntry& entry = sample.tree.entries[at];
    if (entry.kind == Kind::kCorners) {
      for (unsigned i = 0; i < 8; ++i, ++found.corners)
        EXPECT_EQ(entry.corners[i], corners.at(cell, i));
    }
    if (entry.kind == Kind::kSpecial) {
      std::array<std::int64_t, 8> winding{};
      for (unsigned i = 0; i < 8; ++i) winding[i] = corners.at(cell, i);
      EXPECT_TRUE(is_special_cell(sample.tree.specials[entry.first], touching(sample, cell),
                                  corners_of(sample.grid, cell), winding));
      ++found.specials;
    }
    if (entry.kind != Kind::kNode) return;
    for (unsigned octant = 0; octant < 8; ++octant) {
      if ((entry.grey >> octant & 1) != 0) continue;
      const int colour = (entry.black >> octant & 1) - (entry.inverted >> octant & 1);
      const GridCell child = cell.child(octant);
      EXPECT_TRUE(touching(sample, child).empty());
      const std::int64_t first = corners.at(child, 0);
      EXPECT_EQ((first > 0) - (first < 0), colour);
      for (unsigned i = 1; i < 8; ++i) EXPECT_EQ(corners.at(child, i), first);
      ++found.coloured_cells;
    }
  });
  return found;
}

// Expects the entries to form one tree, with consistent fields.
void expect_form(const MaskTree& tree) {
  std::set<std::uint32_t> seen, specials;
  unsigned levels = 0;
  each_entry(tree, [&](const GridCell& cell, std::uint32_t at) {
    ASSERT_LT(at, tree.entries.size());
    EXPECT_TRUE(seen.insert(at).second);
    levels = std::max(levels, cell.level);
    const MaskEntry& entry = tree.entries[at];
    if (entry.kind == Kind::kSpecial) {
      ASSERT_LT(entry.first, tree.specials.size());
      EXPECT_TRUE(specials.insert(entry.first).second);
    }
    if (entry.kind != Kind::kNode) return;
    EXPECT_LT(cell.level, kLevels);
    EXPECT_EQ(entry.grey & entry.black, 0);
    EXPECT_EQ((entry.grey | entry.black) & entry.inverted, 0);
    std::uint32_t child = entry.first;
    if (entry.grey != 0) {
      EXPECT_GT(child, at);
    }
    for (unsigned octant = 0; octant < 8; ++octant) {
      const bool grey = (entry.grey >> octant & 1) != 0;
      EXPECT_EQ((entry.leaf >> octant & 1) != 0, grey && tree.entries[child].kind != Kind::kNode);
      child += grey;
    }
  });
  EXPECT_EQ(seen.size(), tree.entries.size());
  EXPECT_EQ(specials.size(), tree.specials.size());
  EXPECT_EQ(levels, tree.levels);
}

TEST(MaskTree, MatchesAllTrianglesOfEveryModel) {
  Found all;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const SampleMask sample(c.soup);
    expect_form(sample.tree);
    const Found found = expect_truth(sample);
    all.coloured_cells += found.coloured_cells;
    all.corners += found.corners;
    all.specials += found.specials;
    if (HasFailure()) break;
  }
  EXPECT_GT(all.coloured_cells, 500u);
  EXPECT_GT(all.corners, 2000u);
  EXPECT_GT(all.specials, 10u);
}

TEST(MaskTree, HasSpecialCellsWhereFacesAreFlat) {
  const SampleMask sample(box({0, 0, 0}, {0.9, 0.8, 0.7}, 24));
  std::set<unsigned> plane_counts;
  std::size_t points = 0;
  Noise noise(5);
  each_entry(sample.tree, [&](const GridCell& cell, std::uint32_t at) {
    const MaskEntry& entry = sample.tree.entries[at];
    if (entry.kind != Kind::kSpecial) return;
    const SpecialCell& special = sample.tree.specials[entry.first];
    plane_counts.insert(special.plane_count);
    const Point lower = sample.grid.lower(cell), edge = sample.grid.upper(cell) - lower;
    for (int i = 0; i < 10; ++i, ++points) {
      const Vec3 share = noise.point(0, 1);
      const Point point = lower + edge.cwiseProduct(Point(share.x, share.y, share.z));
      bool beyond = false, on_plane = false;
      for (unsigned k = 0; k < special.plane_count; ++k) {
        const auto& [a, b, c] = special.planes[k];
        const int side = orientation(a, b, c, point);
        beyond = beyond || side > 0;
        on_plane = on_plane || side == 0;
      }
      if (on_plane) continue;
      EXPECT_EQ(sample.surface.winding(point), beyond ? special.beyond : special.behind);
    }
  });
  EXPECT_TRUE(plane_counts.contains(1));
  EXPECT_TRUE(plane_counts.contains(2));
  EXPECT_GT(points, 500u);
}

bool same(const MaskTree& a, const MaskTree& b) {
  const auto same_entry = [](const MaskEntry& x, const MaskEntry& y) {
    return x.kind == y.kind && x.grey == y.grey && x.leaf == y.leaf && x.black == y.black &&
           x.inverted == y.inverted && x.first == y.first && x.corners == y.corners;
  };
  const auto same_special = [](const SpecialCell& x, const SpecialCell& y) {
    return x.plane_count == y.plane_count &&
           std::equal(x.planes.begin(), x.planes.begin() + x.plane_count, y.planes.begin()) &&
           x.behind == y.behind && x.beyond == y.beyond;
  };
  return a.levels == b.levels && std::ranges::equal(a.entries, b.entries, same_entry) &&
         std::ranges::equal(a.specials, b.specials, same_special);
}

// Built in many sectors.
TEST(MaskTree, DoesNotDependOnThreads) {
  const SampleMesh mesh =
      store(joined({sphere(6), box({1.1, 0, 0}, {1.9, 0.9, 0.8}, 30), scaled(sphere(3), 0.5)}));
  const auto build = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return mask_of(mesh, 1000); });
  };
  const MaskTree one = build(1);
  EXPECT_GT(one.entries.size(), 2000u);
  EXPECT_GT(one.specials.size(), 3u);
  expect_form(one);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(same(one, build(2)));
}

// Corner numbers beyond 126 cannot be stored; colours can.
TEST(MaskTree, LeavesCornersUncountedWhereNumbersAreLarge) {
  for (const std::size_t count : {126u, 127u, 130u})
    for (const bool turned : {false, true}) {
      SCOPED_TRACE(std::to_string(count) + (turned ? " turned" : ""));
      const SampleMask sample(turned ? inside_out(shells(count)) : shells(count));
      std::set<bool> counted;
      bool black = false, inverted = false;
      each_entry(sample.tree, [&](const GridCell& cell, std::uint32_t at) {
        const MaskEntry& entry = sample.tree.entries[at];
        black = black || entry.black != 0;
        inverted = inverted || entry.inverted != 0;
        if (entry.kind != Kind::kCorners) return;
        const auto said = std::ranges::count(entry.corners, kUncounted);
        EXPECT_TRUE(said == 0 || said == 8);
        counted.insert(said == 0);
        if (said == 8 || at % 16 != 0) return;
        const unsigned corner = at / 16 % 8;
        EXPECT_EQ(entry.corners[corner], sample.surface.winding(sample.grid.corner(cell, corner)));
      });
      EXPECT_EQ(counted.contains(false), count > 126);
      EXPECT_EQ(black, !turned);
      EXPECT_EQ(inverted, turned);
    }
}

// One finest cell holds more triangles than a leaf at other levels may.
TEST(MaskTree, EndsAtTheFinestLevel) {
  const Soup seed =
      translated(scaled(grains(60, 1), 0x1p-24), {0.3 + 0x1p-20, 0.3 + 0x1p-20, 0.3 + 0x1p-20});
  const SampleMask sample(joined({box({0, 0, 0}, {1, 1, 1}), seed}));
  EXPECT_EQ(sample.tree.levels, kLevels);
  expect_form(sample.tree);
  const Found found = expect_truth(sample);
  EXPECT_GT(found.coloured_cells, 100u);
}

// Each level halves the needles in a cell of a fan, and lists each of them twice. Without a limit
// the last of these models has 75,755 cells.
TEST(MaskTree, HasNoMoreCellsIfTheSameTrianglesAreNeedles) {
  const auto cells = [](unsigned sides) {
    return mask_of(store(fan_cylinder_mesh(sides, 32000 / sides).soup())).entries.size();
  };
  EXPECT_GT(cells(250), 4000u);
  for (const unsigned sides : {1000u, 8000u}) EXPECT_LT(cells(sides), 16000u) << sides;
}

// There are few triangles, but most of the root is decided by the two corners where they are.
TEST(MaskTree, DividesCellsThatTheSurfaceOnlyGrazes) {
  const SampleMask sample(
      joined({box({0, 0, 0}, {0.1, 0.1, 0.1}), box({1.55, 1.55, 1.55}, {1.65, 1.65, 1.65})}));
  double grey = 0;
  each_entry(sample.tree, [&](const GridCell& cell, std::uint32_t entry) {
    if (sample.tree.entries[entry].kind != Kind::kNode) grey += std::exp2(-3.0 * cell.level);
  });
  EXPECT_GT(grey, 0);
  EXPECT_LT(grey, 0.01);
  expect_form(sample.tree);
  expect_truth(sample);
}

TEST(MaskTree, IsOneLeafForAFewTriangles) {
  const SampleMask sample(box({0, 0, 0}, {1.75, 1.5, 1.25}));
  ASSERT_EQ(sample.tree.entries.size(), 1u);
  EXPECT_EQ(sample.tree.entries[0].kind, Kind::kCorners);
  EXPECT_EQ(sample.tree.levels, 0u);
  // The box's least corner is perturbed into the solid; all others are outside.
  EXPECT_EQ(sample.tree.entries[0].corners, (MaskCorners{1, 0, 0, 0, 0, 0, 0, 0}));
}

}  // namespace
}  // namespace planetree::octree
