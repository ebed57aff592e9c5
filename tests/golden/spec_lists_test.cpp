// Checks "Lists of blocks" and "Slabs of listed leaves" in the samples, as the independent reader
// decodes them: against every triangle and every cap, clipped exactly by octants or by the cell,
// and against sums of solid angles.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/golden/samples.h"
#include "tests/golden/spec_mask.h"
#include "tests/golden/spec_tree.h"
#include "tests/golden/spec_vector.h"
#include "tests/octree/support/exact_overlap.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::golden {
namespace {

std::vector<Sample> listing_samples() {
  return {sphere_sample(), boxes_sample(), region_sample(), sheet_sample(), tube_sample()};
}

octree::Point to_point(const SpecPoint& point) { return {point[0], point[1], point[2]}; }

class SpecLists : public testing::TestWithParam<Sample> {
 protected:
  SpecLists()
      : file_(read_file(GetParam().ptree_path())),
        mask_(file_),
        tree_(file_),
        whole_(SpecFile(read_file(
            (GetParam().box ? boxes_sample() : GetParam()).ptree_path()))),  // without a region
        all_(whole_.triangles(whole_.root_link())) {
    add_blocks(tree_);
    if (!file_.header().open()) return;
    const SpecTree caps(file_, SpecTree::Of::kCaps);
    add_blocks(caps);
    const std::vector<SpecTriangle> triangles = caps.triangles(caps.root_link());
    all_.insert(all_.end(), triangles.begin(), triangles.end());
  }

  void each_listed(const std::function<void(const SpecCell&, const SpecMaskRecord&)>& look) const {
    mask_.each_grey([&](const SpecCell& cell, const SpecMaskRecord& record) {
      if (record.kind == 5) look(cell, record);
    });
  }

  // The octants that the block's triangles touch.
  unsigned touched(const SpecCell& cell, const SpecBlock& block) const {
    std::vector<octree::Triangle> near;
    for (const SpecTriangle& triangle : block.triangles) {
      near.push_back({to_point(triangle.corners[0]), to_point(triangle.corners[1]),
                      to_point(triangle.corners[2])});
      if (!boxes_meet(near.back(), corner(cell, 0), corner(cell, 7))) near.pop_back();
    }
    unsigned octants = 0;
    for (unsigned i = 0; i < 8 && !near.empty(); ++i) {
      const SpecCell octant = cell.octant(i);
      octants |= unsigned{std::ranges::any_of(near,
                                              [&](const octree::Triangle& triangle) {
                                                return octree::exactly_touches(
                                                    triangle, corner(octant, 0), corner(octant, 7));
                                              })}
                 << i;
    }
    return octants;
  }

  SpecFile file_;
  SpecMask mask_;
  SpecTree tree_;
  SpecTree whole_;
  std::vector<SpecTriangle> all_;  // of the closed surface
  std::map<SpecLink, SpecBlock> blocks_;

 private:
  void add_blocks(const SpecTree& tree) {
    for (const SpecPage& page : tree.pages())
      blocks_.insert(page.blocks.begin(), page.blocks.end());
  }
  octree::Point corner(const SpecCell& cell, unsigned number) const {
    return to_point(mask_.corner(cell, number));
  }
  static bool boxes_meet(const octree::Triangle& triangle, const octree::Point& lower,
                         const octree::Point& upper) {
    const octree::Point least = triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]);
    const octree::Point greatest = triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2]);
    return (least.array() <= upper.array()).all() && (greatest.array() >= lower.array()).all();
  }
};

// Clips a triangle by a closed box. Returns the corners of a polygon, none if they do not touch.
std::vector<SpecPoint> clipped(const std::array<SpecPoint, 3>& triangle, const SpecPoint& lower,
                               const SpecPoint& upper) {
  std::vector<SpecPoint> polygon(triangle.begin(), triangle.end());
  for (std::size_t side = 0; side < 6; ++side) {
    const std::size_t axis = side / 2;
    const bool least = side % 2 == 0;
    const double limit = least ? lower[axis] : upper[axis];
    // Negative outside of this side of the box.
    const auto depth = [&](const SpecPoint& point) {
      return least ? point[axis] - limit : limit - point[axis];
    };
    std::vector<SpecPoint> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const SpecPoint &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
      const double here = depth(from), there = depth(to);
      if (here >= 0) kept.push_back(from);
      if ((here >= 0) == (there >= 0)) continue;
      SpecPoint cut{};
      for (std::size_t k = 0; k < 3; ++k)
        cut[k] = from[k] + here / (here - there) * (to[k] - from[k]);
      cut[axis] = limit;
      kept.push_back(cut);
    }
    polygon = std::move(kept);
  }
  return polygon;
}

INSTANTIATE_TEST_SUITE_P(All, SpecLists, testing::ValuesIn(listing_samples()), sample_name);

TEST_P(SpecLists, LeadToBlocks) {
  std::size_t lists = 0;
  each_listed([&](const SpecCell& cell, const SpecMaskRecord& record) {
    EXPECT_LT(cell.level, 19u);
    for (const SpecListedBlock& listed : record.blocks) EXPECT_TRUE(blocks_.contains(listed.link));
    ++lists;
  });
  EXPECT_GT(lists, 0u);
}

// Only rounding may set extra bits, and the samples have few such cases.
TEST_P(SpecLists, HaveEveryBlockThatTouchesAnOctant) {
  std::size_t bits = 0, needed = 0;
  each_listed([&](const SpecCell& cell, const SpecMaskRecord& record) {
    std::map<SpecLink, unsigned> stated;
    for (const SpecListedBlock& listed : record.blocks) {
      stated[listed.link] = listed.octants;
      for (unsigned i = 0; i < 8; ++i) bits += listed.octants >> i & 1;
    }
    for (const auto& [link, block] : blocks_) {
      const unsigned octants = touched(cell, block);
      EXPECT_EQ(octants & ~stated[link], 0u) << "block " << link << ", level " << cell.level;
      for (unsigned i = 0; i < 8; ++i) needed += octants >> i & 1;
    }
  });
  EXPECT_GT(needed, 0u);
  EXPECT_LE(bits, needed + needed / 100);
}

TEST_P(SpecLists, UnlistedOctantsHaveOneWindingNumber) {
  std::size_t certain = 0;
  each_listed([&](const SpecCell& cell, const SpecMaskRecord& record) {
    unsigned met = 0;
    for (const SpecListedBlock& listed : record.blocks) met |= listed.octants;
    for (unsigned i = 0; i < 8; ++i) {
      if ((met >> i & 1) != 0) continue;
      const SpecPoint lower = mask_.corner(cell.octant(i), 0);
      const SpecPoint size = mask_.corner(cell.octant(i), 7) - lower;
      EXPECT_EQ(mask_.corner(cell.octant(i), i), mask_.corner(cell, i));
      for (int at = 0; at < 8; ++at) {
        SpecPoint point = lower;
        for (unsigned axis = 0; axis < 3; ++axis)
          point[axis] += (0.07 + 0.81 * (at >> axis & 1)) * size[axis];
        ASSERT_GT(whole_.nearest(point).distance, 0);
        const double number = winding_number(all_, point);
        EXPECT_NEAR(number, record.corners[i], 1e-6) << "octant " << i;
        ++certain;
      }
    }
  });
  EXPECT_GT(certain, 0u);
}

// Bounds count in 256ths of the width. Clipping rounds far less than the half step of tolerance
// that readers have.
TEST_P(SpecLists, HaveSlabsThatBoundTheSurface) {
  constexpr double kRounding = 1e-9;
  std::size_t bounds = 0, held = 0;
  each_listed([&](const SpecCell& cell, const SpecMaskRecord& record) {
    const SpecSlab& slab = record.slab;
    bounds += std::size_t{slab.bounds_below()} + std::size_t{slab.bounds_above()};
    if (!slab.bounds_below() && !slab.bounds_above()) return;
    const SpecPoint end = mask_.in_cell(cell, mask_.corner(cell, 7));
    for (const SpecListedBlock& listed : record.blocks)
      for (const SpecTriangle& triangle : blocks_.at(listed.link).triangles) {
        std::array<SpecPoint, 3> corners{};
        for (std::size_t i = 0; i < 3; ++i) corners[i] = mask_.in_cell(cell, triangle.corners[i]);
        for (const SpecPoint& point : clipped(corners, {}, end)) {
          const double steps = 256 * slab.height(point) / slab.width();
          if (slab.bounds_below()) {
            EXPECT_GE(steps, slab.lower + 0.5 - kRounding) << triangle.id;
          }
          if (slab.bounds_above()) {
            EXPECT_LE(steps, slab.upper + 0.5 + kRounding) << triangle.id;
          }
          ++held;
        }
      }
  });
  EXPECT_EQ(bounds > 0, !file_.header().has_walls());
  EXPECT_EQ(held > 0, !file_.header().has_walls());
}

TEST_P(SpecLists, HaveSlabsWithOneWindingNumberOnEitherSide) {
  std::size_t above = 0, below = 0;
  each_listed([&](const SpecCell& cell, const SpecMaskRecord& record) {
    const SpecSlab& slab = record.slab;
    const SpecPoint lower = mask_.corner(cell, 0);
    const SpecPoint size = mask_.corner(cell, 7) - lower;
    for (int at = 0; at < 27; ++at) {
      const std::array<int, 3> index = {at % 3, at / 3 % 3, at / 9};
      SpecPoint point = lower;
      for (std::size_t axis = 0; axis < 3; ++axis)
        point[axis] += (0.03 + 0.46 * index[axis]) * size[axis];
      const SpecPoint u = mask_.in_cell(cell, point);
      const bool is_above = slab.is_above(u), is_below = slab.is_below(u);
      ASSERT_FALSE(is_above && is_below);
      if (!is_above && !is_below) continue;
      ASSERT_GT(whole_.nearest(point).distance, 0);
      const unsigned corner = is_above ? slab.top() : 7 - slab.top();
      EXPECT_NEAR(winding_number(all_, point), record.corners[corner], 1e-6)
          << "corner " << corner << ", level " << cell.level;
      ++(is_above ? above : below);
    }
  });
  EXPECT_EQ(above > 0, !file_.header().has_walls());
  EXPECT_EQ(below > 0, !file_.header().has_walls());
}

// Two cones of many faces: around their tips no leaf can list all blocks.
TEST(SpecListsOfManyBlocks, AreNotStored) {
  constexpr int kSides = 500;
  const storage::TemporaryDirectory folder;
  std::ofstream mesh(folder / "cones.obj");
  mesh << "v 0 0 -1\nv 0 0 1\n";
  for (int i = 0; i < kSides; ++i)
    mesh << "v " << std::cos(0.004 * std::numbers::pi * i) << " "
         << std::sin(0.004 * std::numbers::pi * i) << " 0\n";
  for (int i = 0; i < kSides; ++i) {
    const int here = i + 3, next = (i + 1) % kSides + 3;
    mesh << "f 1 " << next << " " << here << "\nf 2 " << here << " " << next << "\n";
  }
  mesh.close();
  const SpecFile file(build_bytes(folder / "cones.obj", 4096, 1));
  const SpecTree tree(file);
  const std::vector<SpecTriangle> all = tree.triangles(tree.header().root_link());
  const SpecMask mask(file);
  std::size_t plain = 0;
  mask.each_grey([&](const SpecCell& cell, const SpecMaskRecord& record) {
    if (record.kind != 2) return;
    ++plain;
    for (unsigned i = 0; i < 8; ++i) {
      const SpecPoint corner = mask.corner(cell, i);
      if (tree.nearest(corner).distance < 1e-9) continue;
      EXPECT_NEAR(winding_number(all, corner), record.corners[i], 1e-5);
    }
  });
  EXPECT_GT(plain, 0u);
}

}  // namespace
}  // namespace planetree::golden
