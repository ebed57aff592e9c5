#include "octree/build/mask_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <tbb/parallel_for.h>

#include "octree/build/cell_overlap.h"
#include "octree/cell_grid.h"
#include "octree/predicates.h"
#include "octree/strict_math.h"

namespace planetree::octree {
namespace {

/// Cells that fewer touch are not divided further.
constexpr std::size_t kFewTriangles = 48;
/// Nor are those whose triangles have been listed so many times over, in octants
/// of octants, since their number last halved: they are larger than the cell or
/// coincide, and smaller cells would not tell them apart.
constexpr double kMostCopies = 3;
/// A special cell pays for its planes by so many triangles each.
constexpr std::size_t kTrianglesPerPlane = 12;
constexpr std::size_t kMostSpecialTriangles = 4096;
/// Octants of so many triangles are divided side by side.
constexpr std::size_t kParallelTriangles = 16384;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A cell and what is known of it.
struct GreyCell {
  GridCell cell;
  std::vector<std::uint32_t> triangles;  ///< positions; all that may touch it
  std::int64_t winding = 0;              ///< at its least corner
  std::size_t halved = 0;                ///< triangles when their number last halved
  double copies = 1;                     ///< of each triangle since
};

using Octants = std::array<GreyCell, 8>;

/// As crossing(), but most triangles are told apart by their boxes. Steps lead
/// up along every axis, so that a triangle no higher than the segment is below
/// it: such are those in the sides of cells, which take long to tell otherwise.
std::int64_t crossing_if_near(const MovedSegment& segment, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  const Point least = segment.from.cwiseMin(segment.to);
  const Point greatest = segment.from.cwiseMax(segment.to);
  const bool near = (a.cwiseMin(b).cwiseMin(c).array() <= greatest.array()).all() &&
                    (a.cwiseMax(b).cwiseMax(c).array() > least.array()).all();
  return near ? crossing(segment, triangle) : 0;
}

/// winding(from) - winding(to).
std::int64_t count_crossings(const MovedSegment& segment, std::span<const Triangle> triangles) {
  std::int64_t sum = 0;
  for (const Triangle& triangle : triangles) sum += crossing_if_near(segment, triangle);
  return sum;
}

class MaskBuild {
 public:
  explicit MaskBuild(const MeshStore& mesh) : mesh_(mesh), grid_(mesh.lower()) {}

  MaskTree run(const std::vector<MortonKey>& keys) const {
    GreyCell root;
    root.triangles.reserve(keys.size());
    for (const MortonKey& key : keys) root.triangles.push_back(key.position);
    const Point corner = grid_.lower(root.cell);
    Point outside = corner;
    outside.x() = std::min(corner.x() - 1, std::nextafter(corner.x(), -kInfinity));
    root.winding = count_crossings_of({corner, outside}, root.triangles);
    MaskTree tree;
    root.halved = root.triangles.size();
    tree.entries.resize(1);
    grow(std::move(root), tree, 0);
    return tree;
  }

 private:
  std::int64_t count_crossings_of(const MovedSegment& segment,
                                  const std::vector<std::uint32_t>& positions) const {
    std::int64_t sum = 0;
    for (const std::uint32_t position : positions)
      sum += crossing_if_near(segment, mesh_.corners(position));
    return sum;
  }

  // Makes the entry at `place` of a cell; what is below goes to the end.
  void grow(GreyCell grey, MaskTree& tree, std::size_t place) const {
    tree.levels = std::max(tree.levels, grey.cell.level);
    if (make_special(grey, tree, place)) return;
    const std::size_t count = grey.triangles.size();
    if (count <= kFewTriangles || grey.cell.level == kLevels)
      return make_corners(grey, tree, place);
    Octants octants = divide(grey);
    if (!worthwhile(grey, octants)) return make_corners(grey, tree, place);
    grey.triangles = {};
    make_node(octants, tree, place);
    if (count >= kParallelTriangles)
      grow_apart(octants, tree, place);
    else
      grow_in_place(octants, tree, place);
  }

  // Whether octants tell triangles apart; if so, hands on by how much.
  static bool worthwhile(const GreyCell& grey, Octants& octants) {
    std::size_t listed = 0;
    for (const GreyCell& octant : octants) listed += octant.triangles.size();
    const double copies =
        grey.copies * static_cast<double>(listed) / static_cast<double>(grey.triangles.size());
    for (GreyCell& octant : octants) {
      const bool halved = octant.triangles.size() <= grey.halved / 2;
      octant.halved = halved ? octant.triangles.size() : grey.halved;
      octant.copies = halved ? 1 : copies;
    }
    return copies <= kMostCopies;
  }

  Octants divide(const GreyCell& grey) const {
    Octants octants;
    const Point middle = grid_.middle(grey.cell);
    std::array<Point, 8> lower, upper;
    for (unsigned octant = 0; octant < 8; ++octant) {
      octants[octant].cell = grey.cell.child(octant);
      lower[octant] = grid_.lower(octants[octant].cell);
      upper[octant] = grid_.upper(octants[octant].cell);
    }
    for (const std::uint32_t position : grey.triangles) {
      const Triangle triangle = mesh_.corners(position);
      const unsigned near = octants_of_box(triangle, middle);
      const bool alone = std::has_single_bit(near);
      for (unsigned octant = 0; octant < 8; ++octant)
        if ((near >> octant & 1) != 0 &&
            (alone || may_touch(triangle, lower[octant], upper[octant])))
          octants[octant].triangles.push_back(position);
    }
    // Along the edges between the octants' least corners.
    octants[0].winding = grey.winding;
    for (unsigned octant = 1; octant < 8; ++octant) {
      const unsigned before = octant & (octant - 1);
      octants[octant].winding =
          octants[before].winding +
          count_crossings_of({lower[octant], lower[before]}, octants[before].triangles);
    }
    return octants;
  }

  // Octants that the triangle's box touches, one bit each.
  static unsigned octants_of_box(const Triangle& triangle, const Point& middle) {
    constexpr std::array<unsigned, 3> kUpperOctants = {0xaa, 0xcc, 0xf0};
    const auto& [a, b, c] = triangle;
    const Point least = a.cwiseMin(b).cwiseMin(c), greatest = a.cwiseMax(b).cwiseMax(c);
    unsigned octants = 0xff;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const unsigned upper = kUpperOctants[axis];
      if (least[axis] > middle[axis]) octants &= upper;
      if (greatest[axis] < middle[axis]) octants &= ~upper;
    }
    return octants;
  }

  static void make_node(const Octants& octants, MaskTree& tree, std::size_t place) {
    MaskEntry node;
    for (unsigned octant = 0; octant < 8; ++octant) {
      const auto bit = static_cast<std::uint8_t>(1U << octant);
      if (!octants[octant].triangles.empty())
        node.grey |= bit;
      else if (octants[octant].winding > 0)
        node.black |= bit;
      else if (octants[octant].winding < 0)
        node.inverted |= bit;
    }
    node.first = static_cast<std::uint32_t>(tree.entries.size());
    tree.entries.resize(tree.entries.size() + static_cast<unsigned>(std::popcount(node.grey)));
    tree.entries[place] = node;
  }

  void grow_in_place(Octants& octants, MaskTree& tree, std::size_t place) const {
    std::size_t child = tree.entries[place].first;
    for (unsigned octant = 0; octant < 8; ++octant) {
      if (octants[octant].triangles.empty()) continue;
      grow(std::move(octants[octant]), tree, child);
      note_leaf(tree, place, octant, child++);
    }
  }

  void grow_apart(Octants& octants, MaskTree& tree, std::size_t place) const {
    std::array<MaskTree, 8> parts;
    tbb::parallel_for(0U, 8U, [&](unsigned octant) {
      if (octants[octant].triangles.empty()) return;
      parts[octant].entries.resize(1);
      grow(std::move(octants[octant]), parts[octant], 0);
    });
    std::size_t child = tree.entries[place].first;
    for (unsigned octant = 0; octant < 8; ++octant) {
      if (parts[octant].entries.empty()) continue;
      join(std::move(parts[octant]), tree, child);
      note_leaf(tree, place, octant, child++);
    }
  }

  // The part's root becomes the entry at `place`, the rest goes to the end.
  static void join(MaskTree part, MaskTree& tree, std::size_t place) {
    const auto moved = static_cast<std::uint32_t>(tree.entries.size() - 1);
    const auto specials = static_cast<std::uint32_t>(tree.specials.size());
    for (MaskEntry& entry : part.entries) {
      if (entry.kind == MaskEntry::Kind::kNode) entry.first += moved;
      if (entry.kind == MaskEntry::Kind::kSpecial) entry.first += specials;
    }
    tree.entries[place] = part.entries.front();
    tree.entries.insert(tree.entries.end(), part.entries.begin() + 1, part.entries.end());
    tree.specials.insert(tree.specials.end(), part.specials.begin(), part.specials.end());
    tree.levels = std::max(tree.levels, part.levels);
  }

  static void note_leaf(MaskTree& tree, std::size_t node, unsigned octant, std::size_t child) {
    if (tree.entries[child].kind != MaskEntry::Kind::kNode)
      tree.entries[node].leaf |= static_cast<std::uint8_t>(1U << octant);
  }

  std::array<Point, 8> corners_of(const GridCell& cell) const {
    std::array<Point, 8> corners;
    for (unsigned which = 0; which < 8; ++which) corners[which] = grid_.corner(cell, which);
    return corners;
  }

  // From the least corner along the cell's edges.
  static std::array<std::int64_t, 8> count_corners(const std::array<Point, 8>& corners,
                                                   std::span<const Triangle> triangles,
                                                   std::int64_t least) {
    std::array<std::int64_t, 8> winding{least};
    for (unsigned which = 1; which < 8; ++which) {
      const unsigned before = which & (which - 1);
      winding[which] =
          winding[before] + count_crossings({corners[which], corners[before]}, triangles);
    }
    return winding;
  }

  bool make_special(const GreyCell& grey, MaskTree& tree, std::size_t place) const {
    constexpr std::size_t kFirst = 16;
    const std::size_t count = grey.triangles.size();
    if (count < kTrianglesPerPlane || count > kMostSpecialTriangles) return false;
    std::vector<Triangle> triangles;
    for (const std::uint32_t position : grey.triangles) {
      if (triangles.size() == kFirst && !in_few_planes(triangles)) return false;
      triangles.push_back(mesh_.corners(position));
    }
    if (!in_few_planes(triangles)) return false;
    const std::array<Point, 8> corners = corners_of(grey.cell);
    const auto special =
        special_cell(triangles, corners, count_corners(corners, triangles, grey.winding));
    if (!special || special->plane_count * kTrianglesPerPlane > count) return false;
    tree.entries[place].kind = MaskEntry::Kind::kSpecial;
    tree.entries[place].first = static_cast<std::uint32_t>(tree.specials.size());
    tree.specials.push_back(*special);
    return true;
  }

  void make_corners(const GreyCell& grey, MaskTree& tree, std::size_t place) const {
    MaskEntry& entry = tree.entries[place];
    entry.kind = MaskEntry::Kind::kCorners;
    entry.corners.fill(kUncounted);
    std::vector<Triangle> triangles;
    for (const std::uint32_t position : grey.triangles)
      triangles.push_back(mesh_.corners(position));
    const std::array<Point, 8> corners = corners_of(grey.cell);
    const std::array<std::int64_t, 8> winding = count_corners(corners, triangles, grey.winding);
    const auto fits = [](std::int64_t number) {
      return -kUncounted > number && number > kUncounted;
    };
    if (!std::all_of(winding.begin(), winding.end(), fits)) return;
    // Straight through the cell, past all edges; were it ever another number, the
    // cell would be left to longer ways.
    const bool agree =
        winding[7] == winding[0] + count_crossings({corners[7], corners[0]}, triangles);
    assert(agree);
    if (!agree) return;
    for (unsigned which = 0; which < 8; ++which)
      entry.corners[which] = static_cast<std::int8_t>(winding[which]);
  }

  const MeshStore& mesh_;
  const CellGrid grid_;
};

}  // namespace

MaskTree build_mask(const MeshStore& mesh, const std::vector<MortonKey>& keys) {
  return MaskBuild(mesh).run(keys);
}

}  // namespace planetree::octree
