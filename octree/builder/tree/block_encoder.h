#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "octree/builder/sort/morton_order.h"
#include "octree/builder/sort/triangles.h"
#include "octree/builder/tree/chunk_vertices.h"
#include "octree/builder/tree/stream_writer.h"
#include "octree/builder/tree/wide_tree.h"
#include "octree/page/frame.h"
#include "octree/page/page_streams.h"

namespace planetree::octree {

/// Collects the block streams of one page (octree/page/page_streams.h).
///
/// A page stores each position once. A block lists its vertices in the order of the page: first
/// those that an earlier block brought, then its own new ones. The new ones take the next numbers
/// and need no reference.
class BlockEncoder {
 public:
  BlockEncoder(const Triangles& mesh, const ChunkVertices& vertices,
               const std::vector<MortonKey>& keys, const BlockShape& shape)
      : mesh_(mesh), of_chunk_(vertices), keys_(keys), shape_(shape) {
    vertex_of_.reserve(kUsualVertices);
  }

  void add(const WideBlock& block);
  /// Fills in the block fields of the head.
  void describe(PageHead& head) const;
  void write(StreamWriter& writer) const;

 private:
  using Corners = std::array<std::array<std::uint32_t, 3>, kMaxBlockTriangles>;

  static constexpr std::size_t kUsualVertices = 2048;  // in a page of 64 KiB

  std::vector<std::uint32_t> sorted_positions(const WideBlock& block) const;
  void add_ids(const std::vector<std::uint32_t>& positions);
  void add_corners(const Corners& corners, std::size_t count,
                   const std::vector<std::uint32_t>& vertices);
  std::vector<double> coordinates_by_axis() const;

  const Triangles& mesh_;
  const ChunkVertices& of_chunk_;
  const std::vector<MortonKey>& keys_;
  BlockShape shape_;
  std::unordered_map<std::uint32_t, std::uint32_t> vertex_of_;  // page's vertex, by chunk's
  std::vector<std::uint32_t> vertices_;                         // chunk's vertex, by page's
  std::vector<std::uint8_t> triangle_counts_, vertex_counts_, new_counts_;
  std::vector<std::uint16_t> vertex_refs_;
  std::vector<std::byte> corners_;
  std::vector<std::uint64_t> first_ids_, id_steps_;
};

}  // namespace planetree::octree
