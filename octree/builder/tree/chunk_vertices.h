#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "octree/builder/sort/morton_order.h"
#include "octree/builder/sort/triangles.h"
#include "octree/builder/tree/wide_tree.h"
#include "octree/page/frame.h"

namespace planetree::octree {

/// The distinct vertices of a chunk's triangles, and the vertices of each block. Positions with
/// equal bits are one vertex.
class ChunkVertices {
 public:
  explicit ChunkVertices(const Triangles& triangles);

  std::uint32_t size() const { return static_cast<std::uint32_t>(positions_.size()); }
  const Point& operator[](std::uint32_t vertex) const { return positions_[vertex]; }
  /// The vertices of a triangle's corners.
  const std::array<std::uint32_t, 3>& corners(std::uint32_t triangle) const {
    return corners_[triangle];
  }

  /// Lists the vertices of each block: ascending, each once.
  void list_blocks(const std::vector<WideBlock>& blocks, const std::vector<MortonKey>& keys);
  std::span<const std::uint32_t> of_block(std::uint32_t block) const {
    return std::span(listed_).subspan(first_[block], first_[block + 1] - first_[block]);
  }

 private:
  std::vector<Point> positions_;
  std::vector<std::array<std::uint32_t, 3>> corners_;
  std::vector<std::uint32_t> listed_;
  std::vector<std::uint32_t> first_;
};

}  // namespace planetree::octree
