#include "octree/build/patch_vertices.h"

#include <algorithm>
#include <bit>
#include <span>

#include "octree/strict_math.h"
#include "storage/checksum.h"

namespace planetree::octree {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// No coordinate is -0, so that equal positions have equal bits.
std::uint64_t hash_of(const Point& position) {
  return storage::hash64(std::as_bytes(std::span(position.data(), 3)));
}

}  // namespace

PatchVertices::PatchVertices(const Triangles& triangles) : corners_(triangles.size()) {
  std::vector<std::uint32_t> table(std::bit_ceil(std::size_t{4} * triangles.size()), kNone);
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle triangle = triangles.corners(i);
    for (std::size_t k = 0; k < 3; ++k) {
      std::size_t at = hash_of(triangle[k]) & (table.size() - 1);
      while (table[at] != kNone && positions_[table[at]] != triangle[k])
        at = (at + 1) & (table.size() - 1);
      if (table[at] == kNone) {
        table[at] = size();
        positions_.push_back(triangle[k]);
      }
      corners_[i][k] = table[at];
    }
  }
}

void PatchVertices::list_blocks(const std::vector<WideBlock>& blocks,
                                const std::vector<MortonKey>& keys) {
  first_.assign(1, 0);
  listed_.clear();
  for (const WideBlock& block : blocks) {
    const auto begin = static_cast<std::ptrdiff_t>(listed_.size());
    for (std::uint32_t i = block.begin; i < block.end; ++i) {
      const auto& corners = corners_[keys[i].position];
      listed_.insert(listed_.end(), corners.begin(), corners.end());
    }
    std::sort(listed_.begin() + begin, listed_.end());
    listed_.erase(std::unique(listed_.begin() + begin, listed_.end()), listed_.end());
    first_.push_back(static_cast<std::uint32_t>(listed_.size()));
  }
}

}  // namespace planetree::octree
