#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "octree/page/frame.h"
#include "octree/page/raw_streams.h"

namespace planetree::octree {

/// Unpacks the triangle blocks of one page into records of the serving layout. The counts in
/// `streams` have been checked; everything else is checked here. Each fault is one sentence's
/// end, or null.
///
/// From the last block to the first: the coordinates of all vertices stand, vertex by vertex, where
/// the records will be. A record is longer than the vertices that its block brings, so it ends up
/// behind those of the blocks before, which are all that these need.
class BlockDecoder {
 public:
  BlockDecoder(const RawStreams& streams, const BlockShape& shape)
      : streams_(streams), shape_(shape) {}

  /// Before any block.
  ///
  /// records  of all blocks, one behind the other: room for them; must stay.
  const char* start(std::byte* records) noexcept;

  /// Unpacks the last block that has not been unpacked to `record`, its place in `records`.
  const char* decode_last(std::byte* record) noexcept;

 private:
  // Where a block's vertices are among those of the page: some that blocks before have, ascending,
  // then new ones, then the first again up to the block's stride.
  using VertexIndices = std::array<std::uint16_t, kMaxBlockVertices>;

  const char* find_vertices(const BlockHeader& header, VertexIndices& indices);
  const char* store_corners(BlockHeader& header);
  void store_vertices(BlockHeader& header, const VertexIndices& indices, std::byte* record) const;
  void store_float64_vertices(BlockHeader& header, const VertexIndices& indices,
                              std::byte* record) const;
  const char* store_ids(BlockHeader& header, std::byte* record);

  const RawStreams& streams_;
  const BlockShape& shape_;
  const std::byte* vertices_ = nullptr;
  // What the blocks that are left have: all of it is behind these.
  std::size_t block_ = 0;
  std::size_t refs_ = 0;
  std::size_t new_vertices_ = 0;
  std::size_t corner_bytes_ = 0;
  std::size_t id_steps_ = 0;
};

}  // namespace planetree::octree
