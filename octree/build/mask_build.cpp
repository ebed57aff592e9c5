#include "octree/build/mask_build.h"

#include <algorithm>
#include <array>
#include <utility>

#include "octree/build/parallel.h"
#include "octree/build/region_mask.h"
#include "octree/strict_math.h"

namespace planetree::octree {
namespace {

/// Puts the masks of regions together.
class MaskJoin {
 public:
  explicit MaskJoin(const MaskRegions& regions)
      : regions_(regions.all()), least_(regions_.size()), grey_(regions_.size()) {
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

  // parts  the masks of the regions that triangles touch, which are used up.
  MaskTree run(std::vector<MaskTree>& parts) const {
    MaskTree tree;
    tree.entries.resize(1);
    place(0, parts, tree, 0);
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

  void place(std::size_t at, std::vector<MaskTree>& parts, MaskTree& tree,
             std::size_t entry) const {
    const MaskRegions::Region& region = regions_[at];
    tree.levels = std::max(tree.levels, region.cell.level);
    if (!region.divided()) return join(std::move(parts[at]), tree, entry);
    std::array<bool, 8> grey;
    std::array<std::int64_t, 8> winding;
    for (unsigned octant = 0; octant < 8; ++octant) {
      grey[octant] = grey_[region.first_octant + octant];
      winding[octant] = least_[region.first_octant + octant];
    }
    tree.divide(entry, grey, winding);
    std::size_t child = tree.entries[entry].first;
    for (unsigned octant = 0; octant < 8; ++octant) {
      if (!grey[octant]) continue;
      place(region.first_octant + octant, parts, tree, child);
      tree.note_leaf(entry, octant, child++);
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

  const std::vector<MaskRegions::Region>& regions_;
  std::vector<std::int64_t> least_;
  std::vector<bool> grey_;
};

}  // namespace

Result<MaskTree> build_mask(const MaskRegions& regions, const TriangleRuns& runs,
                            const std::function<void()>& done) {
  const MaskJoin join(regions);
  std::vector<MaskTree> parts(regions.all().size());
  const auto built = for_each_in_parallel(parts.size(), [&](std::size_t at) -> Result<void> {
    const MaskRegions::Region& region = regions.all()[at];
    if (!region.divided() && region.touched) {
      const auto triangles = regions.read(at, runs);
      if (!triangles) return triangles.error();
      parts[at] = mask_of_region(regions.grid(), region.cell, join.winding(at), *triangles);
    }
    done();
    return {};
  });
  if (!built) return built.error();
  return join.run(parts);
}

}  // namespace planetree::octree
