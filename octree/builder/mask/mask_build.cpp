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

/// Counts the winding numbers at the sectors' least corners, and joins the sectors' roots.
class MaskJoin {
 public:
  explicit MaskJoin(const MaskSectors& sectors)
      : grid_(sectors.grid()),
        sectors_(sectors.all()),
        min_(sectors_.size()),
        grey_(sectors_.size()) {
    count_corners(0, sectors.winding());
    // Octants come after the sector that they divide.
    for (std::size_t at = sectors_.size(); at-- > 0;) {
      const MaskSectors::Region& sector = sectors_[at];
      grey_[at] = sector.touched;
      for (unsigned octant = 0; sector.divided() && octant < 8; ++octant)
        if (grey_[sector.first_octant + octant]) grey_[at] = true;
    }
  }

  // The winding number at the least corner of a sector.
  std::int64_t winding(std::size_t at) const { return min_[at]; }

  MaskTree run(const std::vector<SectorRoot>& roots) const {
    MaskTree tree;
    tree.entries.resize(1);
    put(0, roots, tree, 0);
    return tree;
  }

 private:
  void count_corners(std::size_t at, std::int64_t least) {
    min_[at] = least;
    if (!sectors_[at].divided()) return;
    const std::size_t first = sectors_[at].first_octant;
    count_corners(first, least);
    // The least corner of an octant is a corner of the octant before it.
    for (unsigned octant = 1; octant < 8; ++octant) {
      const unsigned before = octant & (octant - 1);
      count_corners(first + octant, at_corner(first + before, octant ^ before));
    }
  }

  std::int64_t at_corner(std::size_t at, unsigned which) const {
    while (sectors_[at].divided()) at = sectors_[at].first_octant + which;
    return min_[at] + sectors_[at].rise[which];
  }

  void put(std::size_t at, const std::vector<SectorRoot>& roots, MaskTree& tree,
           std::size_t entry) const {
    const MaskSectors::Region& sector = sectors_[at];
    tree.levels = std::max(tree.levels, sector.cell.level);
    if (!sector.divided()) return add_root(roots[at], tree, entry);
    std::array<bool, 8> grey;
    std::array<std::int64_t, 8> winding;
    for (unsigned octant = 0; octant < 8; ++octant) {
      grey[octant] = grey_[sector.first_octant + octant];
      const bool in_region = grid_.has_part_of(sector.cell.child(octant));
      winding[octant] = in_region ? min_[sector.first_octant + octant] : 0;
    }
    tree.divide(entry, grey, winding);
    std::size_t child = tree.entries[entry].first;
    for (unsigned octant = 0; octant < 8; ++octant) {
      if (!grey[octant]) continue;
      put(sector.first_octant + octant, roots, tree, child);
      tree.note_leaf(entry, octant, child++);
    }
  }

  static void add_root(const SectorRoot& root, MaskTree& tree, std::size_t entry) {
    tree.entries[entry] = root.entry;
    if (!root.special) return;
    tree.entries[entry].first = static_cast<std::uint32_t>(tree.specials.size());
    tree.specials.push_back(*root.special);
  }

  const ClippedGrid& grid_;
  const std::vector<MaskSectors::Region>& sectors_;
  std::vector<std::int64_t> min_;
  std::vector<bool> grey_;
};

/// Lists blocks for the cells of sectors.
class CellBlocks {
 public:
  // trees  without a surface: lists none.
  CellBlocks(const BuiltTrees& trees, const ClippedGrid& grid) {
    if (!trees.surface) return;
    frames_.emplace(trees);
    info_ = trees.info(cap_info_);
    lister_.emplace(info_, grid);
  }
  CellBlocks(const CellBlocks&) = delete;
  CellBlocks& operator=(const CellBlocks&) = delete;

  bool list(const GridCell& cell, MaskBlocks& blocks) {
    return lister_ &&
           lister_->list(cell, frames_->reader(), blocks) == BlockLister::Outcome::kListed;
  }
  Result<void> state() const { return frames_ ? frames_->state() : Result<void>(); }

 private:
  TreeInfo info_, cap_info_;
  std::optional<TreeFrames> frames_;
  std::optional<BlockLister> lister_;
};

}  // namespace

SectorRoot SectorRoot::of(const MaskTree& mask, std::size_t sector) {
  SectorRoot root{mask.entries[0], {}};
  // Roots are stored with the cells above, whose pages hold no lists: few queries reach leaves so
  // large.
  if (root.entry.kind == MaskEntry::Kind::kListed) root.entry.kind = MaskEntry::Kind::kCorners;
  if (root.entry.kind == MaskEntry::Kind::kSpecial) root.special = mask.specials[0];
  if (root.entry.kind == MaskEntry::Kind::kNode) {
    root.entry.kind = MaskEntry::Kind::kSector;
    root.entry.first = static_cast<std::uint32_t>(sector);
  }
  return root;
}

Result<MaskTree> build_mask(const MaskSectors& sectors, const TriangleRuns& runs,
                            const BuiltTrees& trees, const KnownRoots& known,
                            const SectorSink& take) {
  const MaskJoin join(sectors);
  std::vector<SectorRoot> roots(sectors.all().size());
  tbb::enumerable_thread_specific<CellBlocks> threads(
      [&] { return CellBlocks(trees, sectors.grid()); });
  const auto built = for_each_in_parallel(roots.size(), [&](std::size_t at) -> Result<void> {
    const MaskSectors::Region& sector = sectors.all()[at];
    if (sector.divided() || !sector.touched) return {};
    if (const SectorRoot* const root = known(at)) {
      roots[at] = *root;
      return {};
    }
    const auto triangles = sectors.read(at, runs);
    if (!triangles) return triangles.error();
    CellBlocks& blocks = threads.local();
    const MaskTree mask = mask_of_sector(
        sectors.grid(), sector.cell, join.winding(at), sectors.spread(runs), *triangles,
        [&](const GridCell& cell, MaskBlocks& list) { return blocks.list(cell, list); });
    if (!blocks.state()) return blocks.state().error();
    roots[at] = SectorRoot::of(mask, at);
    return take(at, mask, roots[at]);
  });
  if (!built) return built.error();
  return join.run(roots);
}

}  // namespace planetree::octree
