#include "octree/builder/tree/block_slots.h"

#include <algorithm>

namespace planetree::octree {
namespace {

// Greatest minus least index of a block's triangles.
std::uint64_t span_of(const Triangles& triangles, const std::vector<MortonKey>& keys,
                      const WideBlock& block) {
  std::uint64_t least = triangles.index(keys[block.begin].position), greatest = least;
  for (std::uint32_t i = block.begin + 1; i < block.end; ++i) {
    const std::uint64_t index = triangles.index(keys[i].position);
    least = std::min(least, index);
    greatest = std::max(greatest, index);
  }
  return greatest - least;
}

}  // namespace

std::vector<std::uint8_t> block_slots(const Triangles& triangles, const ChunkVertices& vertices,
                                      const std::vector<MortonKey>& keys,
                                      const std::vector<WideBlock>& blocks,
                                      const BlockShape& shape) {
  std::vector<std::uint8_t> slots;
  slots.reserve(blocks.size());
  for (std::uint32_t i = 0; i < blocks.size(); ++i) {
    const auto count = static_cast<unsigned>(vertices.of_block(i).size());
    const bool compact = shape.is_compact(count, span_of(triangles, keys, blocks[i]));
    slots.push_back(static_cast<std::uint8_t>(shape.slots(count, compact)));
  }
  return slots;
}

}  // namespace planetree::octree
