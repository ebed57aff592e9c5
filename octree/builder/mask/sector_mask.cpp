#include "octree/builder/mask/sector_mask.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <numeric>
#include <utility>

#include "octree/builder/mask/distinct_triangles.h"
#include "octree/builder/mask/octant_overlap.h"
#include "octree/builder/mask/slab_fit.h"
#include "octree/builder/surface/edge_count.h"
#include "octree/builder/surface/edge_crossings.h"
#include "octree/geometry/cell_grid.h"
#include "octree/geometry/predicates.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/tree_limits.h"

namespace planetree::octree {
namespace {

/// Cells that at most this many triangles touch are not divided further,
constexpr std::size_t kFewTriangles = 64;
/// unless at most this many of their octants are touched.
constexpr int kFewOctants = 2;
/// Maximum number of times that triangles are listed in octants of octants since their number last
/// halved; with more, cells are not divided further. Such triangles are larger than the cell or
/// coincide, and smaller cells would not separate them.
constexpr double kMaxCopies = 3;
/// Maximum number of times that triangles are listed in the cells of one level, for each triangle
/// of the model: what limits the work on needles. Each level halves their number in a cell, but
/// lists each of them twice.
constexpr double kMaxSpread = 6;
/// More triangles than this are in too many blocks to be listed.
constexpr std::size_t kMaxListedTriangles = kMaxListed * kMaxBlockTriangles;
/// A special cell needs this many triangles for each plane, to be worth the memory of its planes.
constexpr std::size_t kTrianglesPerPlane = 12;
constexpr std::size_t kMaxSpecialTriangles = 4096;

/// A cell and what is known of it.
struct GreyCell {
  GridCell cell;
  std::vector<std::uint32_t> triangles;  ///< positions of all distinct ones that may touch it
  std::size_t count = 0;                 ///< number of these triangles, copies included
  std::int64_t winding = 0;              ///< at its least corner
  std::size_t halved = 0;                ///< number of triangles when it last halved
  double copies = 1;                     ///< how often each triangle was listed since then
  double spread = 1;                     ///< how often each of the model was listed
};

using Octants = std::array<GreyCell, 8>;

class SectorMask {
 public:
  SectorMask(const ClippedGrid& grid, const Triangles& triangles, const ListBlocks& list)
      : grid_(grid), list_(list), count_(triangles.size()), triangles_(distinct(triangles)) {}

  // winding  number at the cell's least corner.
  // spread   how often sectors list the triangles.
  MaskTree run(const GridCell& cell, std::int64_t winding, double spread) const {
    GreyCell sector{cell, {}, count_, winding, count_};
    sector.spread = spread;
    sector.triangles.resize(triangles_.size());
    std::iota(sector.triangles.begin(), sector.triangles.end(), 0);
    MaskTree tree;
    tree.entries.resize(1);
    grow(std::move(sector), tree, 0);
    return tree;
  }

 private:
  // Makes entry `index` for a cell; the entries below it are appended.
  void grow(GreyCell grey, MaskTree& tree, std::size_t index) const {
    tree.levels = std::max(tree.levels, grey.cell.level);
    if (make_special(grey, tree, index)) return;
    if (grey.cell.level == kLevels || (grey.count <= kFewTriangles && !in_few_octants(grey)))
      return make_corners(grey, tree, index);
    Octants octants = divide(grey);
    if (!worthwhile(grey, octants)) return make_corners(grey, tree, index);
    grey.triangles = {};
    add_node(octants, tree, index);
    std::size_t child = tree.entries[index].first;
    for (unsigned octant = 0; octant < 8; ++octant) {
      if (octants[octant].triangles.empty()) continue;
      grow(std::move(octants[octant]), tree, child);
      tree.note_leaf(index, octant, child++);
    }
  }

  // Whether the surface only grazes the cell, so that most of it will be white or black.
  bool in_few_octants(const GreyCell& grey) const {
    const Point middle = grid_.middle(grey.cell);
    unsigned near = 0;
    for (const std::uint32_t position : grey.triangles)
      near |= octants_of_box(triangles_[position], middle);
    return std::popcount(near) <= kFewOctants;
  }

  // Whether octants separate the triangles. Sets `halved` and `copies` of the octants.
  static bool worthwhile(const GreyCell& grey, Octants& octants) {
    std::size_t listed = 0;
    for (const GreyCell& octant : octants) listed += octant.count;
    const double growth = static_cast<double>(listed) / static_cast<double>(grey.count);
    const double copies = grey.copies * growth, spread = grey.spread * growth;
    for (GreyCell& octant : octants) {
      const bool halved = octant.count <= grey.halved / 2;
      octant.halved = halved ? octant.count : grey.halved;
      octant.copies = halved ? 1 : copies;
      octant.spread = spread;
    }
    return copies <= kMaxCopies && spread <= kMaxSpread;
  }

  Octants divide(const GreyCell& grey) const {
    Octants octants;
    std::array<Point, 8> lower;  // also the corners of octant 0
    for (unsigned octant = 0; octant < 8; ++octant) {
      octants[octant].cell = grey.cell.child(octant);
      lower[octant] = grid_.lower(octants[octant].cell);
    }
    hand_out(grey, octants);
    octants[0].winding = grey.winding;
    const std::array<std::int64_t, 8> winding = edge_count(lower, octants[0]).all();
    for (unsigned octant = 0; octant < 8; ++octant) octants[octant].winding = winding[octant];
    for (GreyCell& octant : octants)
      if (!grid_.has_part_of(octant.cell)) octant = {octant.cell, {}};
    return octants;
  }

  // Gives each octant the triangles that may touch it, in order.
  void hand_out(const GreyCell& grey, Octants& octants) const {
    const std::vector<std::uint8_t> touched = octants_touched(grey);
    std::array<std::size_t, 8> counts{};
    for (unsigned left : touched)
      for (; left != 0; left &= left - 1) ++counts[static_cast<unsigned>(std::countr_zero(left))];
    for (unsigned octant = 0; octant < 8; ++octant)
      octants[octant].triangles.reserve(counts[octant]);
    for (std::size_t i = 0; i < touched.size(); ++i)
      for (unsigned left = touched[i]; left != 0; left &= left - 1) {
        GreyCell& octant = octants[static_cast<unsigned>(std::countr_zero(left))];
        octant.triangles.push_back(grey.triangles[i]);
        octant.count += static_cast<std::size_t>(triangles_[grey.triangles[i]].copies);
      }
  }

  // The octants that each triangle may touch, one bit each.
  std::vector<std::uint8_t> octants_touched(const GreyCell& grey) const {
    const Point middle = grid_.middle(grey.cell);
    std::vector<std::uint8_t> touched(grey.triangles.size());
    OctantOverlap overlap(grid_.lower(grey.cell), middle, grid_.upper(grey.cell));
    const auto settle = [&] {
      const OctantOverlap::TouchedOctants touched_octants = overlap.take();
      for (unsigned k = 0; k < touched_octants.count; ++k)
        touched[touched_octants.indices[k]] = touched_octants.octants[k];
    };
    constexpr std::uint32_t kAhead = 16;
    for (std::uint32_t i = 0; i < touched.size(); ++i) {
      if (i + kAhead < touched.size()) __builtin_prefetch(&triangles_[grey.triangles[i + kAhead]]);
      const BoxedTriangle& triangle = triangles_[grey.triangles[i]];
      const unsigned near = octants_of_box(triangle, middle);
      touched[i] = static_cast<std::uint8_t>(near);
      if ((near & (near - 1)) == 0) continue;
      overlap.add(triangle.corners, near, i);
      if (overlap.full()) settle();
    }
    settle();
    return touched;
  }

  static void add_node(const Octants& octants, MaskTree& tree, std::size_t index) {
    std::array<bool, 8> grey;
    std::array<std::int64_t, 8> winding;
    for (unsigned octant = 0; octant < 8; ++octant) {
      grey[octant] = !octants[octant].triangles.empty();
      winding[octant] = octants[octant].winding;
    }
    tree.divide(index, grey, winding);
  }

  std::array<Point, 8> corners_of(const GridCell& cell) const {
    std::array<Point, 8> corners;
    for (unsigned which = 0; which < 8; ++which) corners[which] = grid_.corner(cell, which);
    return corners;
  }

  EdgeCount edge_count(const std::array<Point, 8>& corners, const GreyCell& grey) const {
    return EdgeCount(corners, grey.winding, triangles_, grey.triangles);
  }

  bool make_special(const GreyCell& grey, MaskTree& tree, std::size_t index) const {
    const std::size_t count = grey.triangles.size();
    if (grey.count < kTrianglesPerPlane || count > kMaxSpecialTriangles) return false;
    // The planes of a special cell also tell which points are on the surface.
    if (std::any_of(grey.triangles.begin(), grey.triangles.end(),
                    [this](std::uint32_t position) { return triangles_[position].is_cap; }))
      return false;
    // A few triangles, far apart in the list, usually decide.
    constexpr std::size_t kSamples = 8;
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < kSamples; ++i)
      triangles.push_back(triangles_[grey.triangles[i * count / kSamples]].corners);
    if (!in_few_planes(triangles)) return false;
    triangles.clear();
    for (const std::uint32_t position : grey.triangles)
      triangles.push_back(triangles_[position].corners);
    if (!in_few_planes(triangles)) return false;
    const std::array<Point, 8> corners = corners_of(grey.cell);
    const auto special = special_cell(triangles, corners, edge_count(corners, grey).all());
    if (!special || special->plane_count * kTrianglesPerPlane > grey.count) return false;
    tree.entries[index].kind = MaskEntry::Kind::kSpecial;
    tree.entries[index].first = static_cast<std::uint32_t>(tree.specials.size());
    tree.specials.push_back(*special);
    return true;
  }

  void make_corners(const GreyCell& grey, MaskTree& tree, std::size_t index) const {
    MaskEntry& entry = tree.entries[index];
    entry.kind = MaskEntry::Kind::kCorners;
    entry.corners.fill(kUncounted);
    const std::array<Point, 8> corners = corners_of(grey.cell);
    const EdgeCount count = edge_count(corners, grey);
    const std::array<std::int64_t, 8> winding = count.all();
    const auto fits = [](std::int64_t number) {
      return -kListedTag > number && number > kListedTag;
    };
    if (!std::all_of(winding.begin(), winding.end(), fits)) return;
    // Counts along other edges. If the numbers differed, the corners would stay uncounted, and
    // queries in the cell would take longer.
    const bool agree =
        winding[7] == winding[5] + count.rise(7, 5) && winding[7] == winding[3] + count.rise(7, 3);
    assert(agree);
    if (!agree) return;
    for (unsigned which = 0; which < 8; ++which)
      entry.corners[which] = static_cast<std::int8_t>(winding[which]);
    list_blocks(grey, tree, index);
  }

  // Lists blocks if the numbers at the corners differ by at most 1, so that one bit a corner is
  // enough.
  void list_blocks(const GreyCell& grey, MaskTree& tree, std::size_t index) const {
    const GridCell& cell = grey.cell;
    MaskEntry& entry = tree.entries[index];
    const auto [least, greatest] = std::minmax_element(entry.corners.begin(), entry.corners.end());
    if (cell.level == kLevels || *greatest - *least > 1 || grey.count > kMaxListedTriangles) return;
    MaskBlocks blocks;
    // A cell that the surface misses by less than rounding may have no octant that is touched.
    if (!list_(cell, blocks) || blocks.count == 0) return;
    if (!grid_.region().has_walls())
      blocks.slab = fit_slab(cell, grid_.lower(cell), triangles_, grey.triangles);
    entry.kind = MaskEntry::Kind::kListed;
    entry.first = static_cast<std::uint32_t>(tree.lists.size());
    tree.lists.push_back(blocks);
  }

  const ClippedGrid& grid_;
  const ListBlocks& list_;
  const std::size_t count_;
  const std::vector<BoxedTriangle> triangles_;
};

}  // namespace

MaskTree mask_of_sector(const ClippedGrid& grid, const GridCell& cell, std::int64_t winding,
                        std::uint64_t spread, const Triangles& triangles, const ListBlocks& list) {
  return SectorMask(grid, triangles, list).run(cell, winding, static_cast<double>(spread));
}

}  // namespace planetree::octree
