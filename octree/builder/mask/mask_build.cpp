#include "octree/builder/mask/mask_build.h"

#include <array>
#include <optional>
#include <utility>

#include <tbb/enumerable_thread_specific.h>

#include "octree/builder/job/parallel.h"
#include "octree/builder/mask/block_lister.h"
#include "octree/builder/mask/sector_mask.h"
#include "octree/builder/mask/tree_frames.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

/// Counts the regions' least corners, and puts their roots together.
class MaskJoin {
 public:
  explicit MaskJoin(const MaskRegions& regions)
      : grid_(regions.grid()),
        regions_(regions.all()),
        least_(regions_.size()),
        grey_(regions_.size()) {
    count_corners(0, regions.winding());
    // Octants come after the region they divide.
    for (std::size_t at = regions_.size(); at-- > 0;) {
      const MaskRegions::Region& region = regions_[at];
      grey_[at] = region.touched;
      for (unsigned octant = 0; region.divided() && octant < 8; ++octant)
        if (grey_[region.first_octant + octant]) grey_[at] = true;
    }
  }

  // At a region's least corner.
  std::int64_t winding(std::size_t at) const { return least_[at]; }

  MaskTree run(const std::vector<RegionRoot>& roots) const {
    MaskTree tree;
    tree.entries.resize(1);
    place(0, roots, tree, 0);
    return tree;
  }

 private:
  void count_corners(std::size_t at, std::int64_t least) {
    least_[at] = least;
    if (!regions_[at].divided()) return;
    const std::size_t first = regions_[at].first_octant;
    count_corners(first, least);
    // The least corner of an octant is a corner of the octant before it.
    for (unsigned octant = 1; octant < 8; ++octant) {
      const unsigned before = octant & (octant - 1);
      count_corners(first + octant, at_corner(first + before, octant ^ before));
    }
  }

  std::int64_t at_corner(std::size_t at, unsigned which) const {
    while (regions_[at].divided()) at = regions_[at].first_octant + which;
    return least_[at] + regions_[at].rise[which];
  }

  void place(std::size_t at, const std::vector<RegionRoot>& roots, MaskTree& tree,
             std::size_t entry) const {
    const MaskRegions::Region& region = regions_[at];
    tree.levels = std::max(tree.levels, region.cell.level);
    if (!region.divided()) return place_root(roots[at], tree, entry);
    std::array<bool, 8> grey;
    std::array<std::int64_t, 8> winding;
    for (unsigned octant = 0; octant < 8; ++octant) {
      grey[octant] = grey_[region.first_octant + octant];
      const bool asked_for = grid_.has_part_of(region.cell.child(octant));
      winding[octant] = asked_for ? least_[region.first_octant + octant] : 0;
    }
    tree.divide(entry, grey, winding);
    std::size_t child = tree.entries[entry].first;
    for (unsigned octant = 0; octant < 8; ++octant) {
      if (!grey[octant]) continue;
      place(region.first_octant + octant, roots, tree, child);
      tree.note_leaf(entry, octant, child++);
    }
  }

  static void place_root(const RegionRoot& root, MaskTree& tree, std::size_t entry) {
    tree.entries[entry] = root.entry;
    if (!root.special) return;
    tree.entries[entry].first = static_cast<std::uint32_t>(tree.specials.size());
    tree.specials.push_back(*root.special);
  }

  const ClippedGrid& grid_;
  const std::vector<MaskRegions::Region>& regions_;
  std::vector<std::int64_t> least_;
  std::vector<bool> grey_;
};

/// Lists blocks for the cells of regions.
class CellBlocks {
 public:
  // tree  null: it lists none.
  CellBlocks(const BuiltTree* tree, const ClippedGrid& grid) {
    if (!tree) return;
    frames_.emplace(*tree);
    facts_ = tree->facts();
    lister_.emplace(facts_, grid);
  }
  CellBlocks(const CellBlocks&) = delete;
  CellBlocks& operator=(const CellBlocks&) = delete;

  bool list(const GridCell& cell, MaskBlocks& blocks) {
    return lister_ &&
           lister_->list(cell, frames_->reader(), blocks) == BlockLister::Outcome::kListed;
  }
  Result<void> state() const { return frames_ ? frames_->state() : Result<void>(); }

 private:
  TreeFacts facts_;
  std::optional<TreeFrames> frames_;
  std::optional<BlockLister> lister_;
};

}  // namespace

RegionRoot RegionRoot::of(const MaskTree& mask, std::size_t region) {
  RegionRoot root{mask.entries[0], {}};
  // Roots go with the cells above, whose pages hold no lists: of leaves so large few are asked.
  if (root.entry.kind == MaskEntry::Kind::kListed) root.entry.kind = MaskEntry::Kind::kCorners;
  if (root.entry.kind == MaskEntry::Kind::kSpecial) root.special = mask.specials[0];
  if (root.entry.kind == MaskEntry::Kind::kNode) {
    root.entry.kind = MaskEntry::Kind::kRegion;
    root.entry.first = static_cast<std::uint32_t>(region);
  }
  return root;
}

Result<MaskTree> build_mask(const MaskRegions& regions, const TriangleRuns& runs,
                            const BuiltTree* tree, const KnownRoots& known,
                            const RegionSink& take) {
  const MaskJoin join(regions);
  std::vector<RegionRoot> roots(regions.all().size());
  tbb::enumerable_thread_specific<CellBlocks> threads(
      [&] { return CellBlocks(tree, regions.grid()); });
  const auto built = for_each_in_parallel(roots.size(), [&](std::size_t at) -> Result<void> {
    const MaskRegions::Region& region = regions.all()[at];
    if (region.divided() || !region.touched) return {};
    if (const RegionRoot* const root = known(at)) {
      roots[at] = *root;
      return {};
    }
    const auto triangles = regions.read(at, runs);
    if (!triangles) return triangles.error();
    CellBlocks& blocks = threads.local();
    const MaskTree mask = mask_of_region(
        regions.grid(), region.cell, join.winding(at), *triangles,
        [&](const GridCell& cell, MaskBlocks& list) { return blocks.list(cell, list); });
    if (!blocks.state()) return blocks.state().error();
    roots[at] = RegionRoot::of(mask, at);
    return take(at, mask, roots[at]);
  });
  if (!built) return built.error();
  return join.run(roots);
}

}  // namespace planetree::octree
