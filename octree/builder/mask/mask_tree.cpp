#include "octree/builder/mask/mask_tree.h"

#include <bit>

#include "octree/geometry/strict_math.h"

namespace planetree::octree {

void MaskTree::divide(std::size_t index, const std::array<bool, 8>& grey,
                      const std::array<std::int64_t, 8>& winding) {
  MaskEntry node;
  for (unsigned octant = 0; octant < 8; ++octant) {
    const auto bit = static_cast<std::uint8_t>(1U << octant);
    if (grey[octant])
      node.grey |= bit;
    else if (winding[octant] > 0)
      node.black |= bit;
    else if (winding[octant] < 0)
      node.inverted |= bit;
  }
  node.first = static_cast<std::uint32_t>(entries.size());
  entries.resize(entries.size() + static_cast<unsigned>(std::popcount(node.grey)));
  entries[index] = node;
}

void MaskTree::note_leaf(std::size_t node, unsigned octant, std::size_t child) {
  if (entries[child].is_leaf()) entries[node].leaf |= static_cast<std::uint8_t>(1U << octant);
}

}  // namespace planetree::octree
