#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "octree/page/frame.h"
#include "octree/page/page_streams.h"

namespace planetree::octree {

/// Unpacks the triangle blocks of one page into records of the serving layout. The counts in
/// `streams` have been checked; everything else is checked here. Functions return null, or a fault:
/// the end of a sentence for an error message.
///
/// Blocks are decoded in place, from the last to the first. start() writes the coordinates of the
/// page's vertices, vertex by vertex, to the memory of the records. A record is longer than the
/// vertices that its block adds to the page. Each record therefore lies behind the vertices of all
/// earlier blocks, which need no others.
class BlockDecoder {
 public:
  BlockDecoder(const RawStreams& streams, const BlockShape& shape)
      : streams_(streams), shape_(shape) {}

  /// Prepares for decode_last(). Call it once, before any block.
  ///
  /// records  memory for the records of all blocks, one after the other; must outlive this object
  const char* start(std::byte* records) noexcept;

  /// Unpacks the last block that is not yet unpacked into `record`, its position in `records`.
  const char* decode_last(std::byte* record) noexcept;

 private:
  // Indices of a block's vertices among those of the page: first those that earlier blocks have,
  // ascending, then the new ones, then the first again up to the block's stride.
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
  // Counts of what the blocks not yet decoded hold. Each is also the end of their part of a stream.
  std::size_t block_ = 0;
  std::size_t refs_ = 0;
  std::size_t new_vertices_ = 0;
  std::size_t corner_bytes_ = 0;
  std::size_t id_steps_ = 0;
};

}  // namespace planetree::octree
