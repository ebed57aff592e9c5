#include "octree/colour_map.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "octree/mask_records.h"
#include "octree/strict_math.h"

namespace planetree::octree {

// Paints what the nodes of the first pages say.
class ColourMap::Painter {
 public:
  Painter(ColourMap& map, unsigned level, const MaskFacts& mask, PageReader pages)
      : map_(map), level_(level), records_(mask, pages) {}

  void run() {
    const std::byte* root = records_.root(work_);
    if (root && records_.root_is_node() && level_ > 0) paint_children(root, {});
  }

 private:
  // To a page and back: what opening a model may take.
  static constexpr std::uint64_t kMostTurns = 512;

  void paint_children(const std::byte* record, const GridCell& cell) {
    const MaskNode node = *reinterpret_cast<const MaskNode*>(record);  // may go with its page
    for (unsigned octant = 0; octant < 8; ++octant) {
      const bool grey = (node.grey >> octant & 1) != 0, leaf = (node.leaf >> octant & 1) != 0;
      if (!grey)
        paint(cell.child(octant), 1 + (node.black >> octant & 1) - (node.inverted >> octant & 1));
      else if (!leaf && cell.level + 1 < level_)
        descend(node, octant, cell);
    }
  }

  void descend(const MaskNode& node, unsigned octant, const GridCell& cell) {
    if (!records_.has_family_at_hand(node) && work_.page_turns >= kMostTurns) return;
    if (const std::byte* child = records_.child(node, octant, work_))
      paint_children(child, cell.child(octant));
  }

  void paint(const GridCell& cell, int colour) {
    const unsigned shift = level_ - cell.level;
    std::array<std::uint32_t, 3> first{}, end{};
    for (unsigned axis = 0; axis < 3; ++axis) {
      first[axis] = cell.at[axis] << shift;
      end[axis] = std::min((cell.at[axis] + 1) << shift, map_.count_[axis]);
    }
    for (std::uint32_t z = first[2]; z < end[2]; ++z)
      for (std::uint32_t y = first[1]; y < end[1]; ++y)
        for (std::uint32_t x = first[0]; x < end[0]; ++x)
          set((std::size_t{z} * map_.count_[1] + y) * map_.count_[0] + x, colour);
  }
  void set(std::size_t cell, int colour) {
    std::uint8_t& four = map_.colours_[cell / 4];
    const unsigned at = 2 * (cell % 4);
    four = static_cast<std::uint8_t>((four & ~(3U << at)) | static_cast<unsigned>(colour) << at);
  }

  ColourMap& map_;
  const unsigned level_;
  MaskRecords records_;
  TreeWork work_;
};

void ColourMap::fill(const MaskFacts& mask, const TreeFacts& tree, std::uint64_t triangles,
                     PageReader pages, std::span<std::uint8_t> memory) noexcept {
  // A forged header may tell of a box that does not fit the root.
  const Point size = tree.box_upper - mask.lower;
  const bool fits = (size.array() >= 0).all() && (size.array() <= 2).all();
  if (mask.page_count == 0 || !fits) return;
  assert(memory.size() >= bytes(triangles));
  colours_ = memory.data();
  std::memset(colours_, 0xff, bytes(triangles));
  lower_ = mask.lower;
  // The finest cells of which there are not too many in the box.
  unsigned level = 0;
  for (unsigned finer = 0; finer <= kLevels; ++finer) {
    const double per_unit = 0.5 * static_cast<double>(std::uint64_t{1} << finer);
    std::array<std::uint32_t, 3> count{};
    double cells = 1;
    for (unsigned axis = 0; axis < 3; ++axis) {
      count[axis] = static_cast<std::uint32_t>(size[axis] * per_unit) + 1;
      cells *= count[axis];
    }
    if (cells > static_cast<double>(most_cells(triangles))) break;
    level = finer;
    count_ = count;
    cells_per_unit_ = per_unit;
    cell_side_ = 1 / per_unit;
  }
  Painter(*this, level, mask, pages).run();
}

}  // namespace planetree::octree
