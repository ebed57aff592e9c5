#include "octree/build/block_lister.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

#include "octree/box_walk.h"
#include "octree/build/cell_overlap.h"
#include "octree/outcodes.h"
#include "octree/strict_math.h"

namespace planetree::octree {
namespace {

/// The octants of a cell.
class Octants {
 public:
  Octants(const ClippedGrid& grid, const GridCell& cell)
      : lower_(grid.lower(cell)),
        upper_(grid.upper(cell)),
        codes_(lower_, grid.middle(cell), upper_) {
    for (unsigned octant = 0; octant < 8; ++octant)
      boxes_[octant] = {grid.lower(cell.child(octant)), grid.upper(cell.child(octant))};
  }

  const Point& lower() const { return lower_; }
  const Point& upper() const { return upper_; }

  /// A bit for each that some triangle of a block may touch.
  std::uint8_t touched_by(const BlockView& block) const {
    const OctantCodes::Met met = codes_.met_by(block);
    unsigned touched = met.with_vertex;
    for (unsigned i = 0; i < block.triangle_count(); ++i) {
      unsigned near = met.by_box[i] & ~touched;
      if (near == 0) continue;
      const Triangle triangle = block.triangle(i);
      for (; near != 0; near &= near - 1) {
        const auto octant = static_cast<unsigned>(std::countr_zero(near));
        if (may_touch(triangle, boxes_[octant].first, boxes_[octant].second))
          touched |= 1U << octant;
      }
    }
    return static_cast<std::uint8_t>(touched);
  }

 private:
  const Point lower_, upper_;
  const OctantCodes codes_;
  std::array<std::pair<Point, Point>, 8> boxes_;
};

}  // namespace

BlockLister::Outcome BlockLister::list(const GridCell& cell, PageReader pages,
                                       MaskBlocks& blocks) const {
  const Octants octants(grid_, cell);
  std::array<std::pair<std::uint32_t, std::uint8_t>, kMostListed> found;
  std::size_t count = 0;
  TreeWork work;
  const bool complete = BoxWalk(tree_, octants.lower(), octants.upper(), pages, work)
                            .run(std::numeric_limits<std::uint64_t>::max(),
                                 [&](const BlockView& block, std::uint32_t link) {
                                   const std::uint8_t touched = octants.touched_by(block);
                                   if (touched == 0) return;
                                   if (count < kMostListed) found[count] = {link, touched};
                                   ++count;
                                 });
  if (!complete) return Outcome::kLost;
  if (count > kMostListed) return Outcome::kTooMany;
  std::sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
  blocks.count = static_cast<std::uint8_t>(count);
  for (std::size_t i = 0; i < count; ++i) {
    blocks.links[i] = found[i].first;
    blocks.octants[i] = found[i].second;
  }
  return Outcome::kListed;
}

}  // namespace planetree::octree
