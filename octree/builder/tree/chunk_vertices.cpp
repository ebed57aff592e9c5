#include "octree/builder/tree/chunk_vertices.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "octree/geometry/strict_math.h"
#include "storage/file/checksum.h"

namespace planetree::octree {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
/// Triangles whose table entries are prefetched before the first of them is used.
constexpr std::uint32_t kAtOnce = 16;

// No coordinate is -0, so that equal positions have equal bits.
std::uint64_t hash_of(const Point& position) {
  return storage::hash64(std::as_bytes(std::span(position.data(), 3)));
}

}  // namespace

ChunkVertices::ChunkVertices(const Triangles& triangles) : corners_(triangles.size()) {
  std::vector<std::uint32_t> table(std::bit_ceil(std::size_t{4} * triangles.size()), kNone);
  const std::size_t last = table.size() - 1;
  std::array<Triangle, kAtOnce> corners;
  std::array<std::array<std::size_t, 3>, kAtOnce> first_slots;
  for (std::uint32_t first = 0; first < triangles.size(); first += kAtOnce) {
    const std::uint32_t count = std::min(kAtOnce, triangles.size() - first);
    for (std::uint32_t i = 0; i < count; ++i) {
      corners[i] = triangles.corners(first + i);
      for (std::size_t k = 0; k < 3; ++k) {
        first_slots[i][k] = hash_of(corners[i][k]) & last;
        __builtin_prefetch(&table[first_slots[i][k]]);
      }
    }
    for (std::uint32_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        std::size_t at = first_slots[i][k];
        while (table[at] != kNone && positions_[table[at]] != corners[i][k]) at = (at + 1) & last;
        if (table[at] == kNone) {
          table[at] = size();
          positions_.push_back(corners[i][k]);
        }
        corners_[first + i][k] = table[at];
      }
  }
}

void ChunkVertices::list_blocks(const std::vector<WideBlock>& blocks,
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
