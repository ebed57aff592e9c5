#include "octree/build/block_slots.h"

#include <algorithm>

namespace planetree::octree {

bool is_compact(const Triangles& triangles, const std::vector<MortonKey>& keys,
                const WideBlock& block, unsigned vertex_count, const BlockShape& shape) {
  if (!shape.may_be_compact(vertex_count)) return false;
  std::uint64_t least = triangles.index(keys[block.begin].position), greatest = least;
  for (std::uint32_t i = block.begin + 1; i < block.end; ++i) {
    const std::uint64_t index = triangles.index(keys[i].position);
    least = std::min(least, index);
    greatest = std::max(greatest, index);
  }
  return greatest - least <= BlockHeader::kMostCompactSpan;
}

std::vector<std::uint8_t> block_slots(const Triangles& triangles, const PatchVertices& vertices,
                                      const std::vector<MortonKey>& keys,
                                      const std::vector<WideBlock>& blocks,
                                      const BlockShape& shape) {
  std::vector<std::uint8_t> slots;
  slots.reserve(blocks.size());
  for (std::uint32_t i = 0; i < blocks.size(); ++i) {
    const auto count = static_cast<unsigned>(vertices.of_block(i).size());
    const bool compact = is_compact(triangles, keys, blocks[i], count, shape);
    slots.push_back(static_cast<std::uint8_t>(shape.slots(count, compact)));
  }
  return slots;
}

}  // namespace planetree::octree
