#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "octree/mask/side_grid.h"
#include "tests/octree/mask/random_mask.h"
#include "tests/octree/support/sample_mask.h"

namespace planetree::octree {

inline constexpr std::size_t kMany = 1 << 24;  // bytes

/// A side grid of a random mask, with the results of the mask itself for comparison.
class RandomSideGrid : public testing::Test {
 protected:
  static TreeInfo tree_of(const Point& lower, const Point& size) {
    TreeInfo tree;
    tree.box_lower = lower;
    tree.box_upper = lower + size;
    tree.core_lower = tree.box_lower;
    tree.core_upper = tree.box_upper;
    return tree;
  }
  SideGrid grid_of(MaskPages& pages, std::size_t bytes) {
    return grid_of(pages, pages.resident_reader(), bytes);
  }
  SideGrid grid_of(MaskPages& pages, PageReader reader, std::size_t bytes) {
    SideGrid grid;
    memory_.resize(bytes);
    grid.fill(pages.mask(lower_), tree_of(lower_, size_), CapGrid(), false, 0, reader, memory_);
    return grid;
  }
  // Random points, half of them on the sides of cells.
  std::vector<Point> points(std::size_t count) const {
    Noise noise(9);
    std::vector<Point> result;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 p = noise.point(0, 1);
      Point step = Point(p.x, p.y, p.z).cwiseProduct(size_);
      if (i % 2 == 0)
        for (double& value : step) value = std::floor(value * 32) / 32;
      result.push_back(lower_ + step);
    }
    return result;
  }
  static int find_fast(const SideGrid& grid, const Point& point) {
    return grid.find_fast(point.x(), point.y(), point.z());
  }
  MaskLookup look(MaskPages& pages, const Point& point) const { return look(pages, lower_, point); }
  static MaskLookup look(MaskPages& pages, const Point& lower, const Point& point) {
    TraversalStats work;
    return look_up(pages.mask(lower), point, ~std::uint64_t{0}, pages.reader(), work);
  }
  // The sign of the winding number where the mask alone determines it: in coloured cells, in
  // octants of leaves that no listed block touches, and beyond the slabs of leaves.
  static std::optional<int> sign_by_mask(MaskPages& pages, const Point& lower, const Point& point) {
    const MaskLookup found = look(pages, lower, point);
    if (found.kind == MaskLookup::Kind::kColour) return found.winding;
    if (found.kind != MaskLookup::Kind::kCorners || found.blocks.count == 0) return {};
    const CellGrid grid(lower);
    unsigned corner = grid.octant(found.cell, point), touched = 0;
    for (unsigned i = 0; i < found.blocks.count; ++i) touched |= found.blocks.octants[i];
    if ((touched >> corner & 1) != 0) {
      const Point position = CellSlab::position_in(point, grid.lower(found.cell), found.cell.level);
      corner = found.blocks.slab.corner_beyond(position);
      if (corner == CellSlab::kNoCorner) return {};
    }
    const int winding = corner_number(found.listed, corner);
    return (winding > 0) - (winding < 0);
  }

  // Whether the side grid stores only the position of this list, because its corner numbers are
  // rare.
  static bool has_rare_corners(const MaskLookup& found) {
    return found.kind == MaskLookup::Kind::kCorners && found.blocks.count > 0 &&
           !SideGridRecord::has(found.listed);
  }

  const Point lower_{-0.25, 3, 1.0 / 3};
  const Point size_{1.2, 1.9, 0.7};
  std::vector<std::byte> memory_;  // memory of the last side grid
};

}  // namespace planetree::octree
