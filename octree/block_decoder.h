#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "octree/frame.h"
#include "octree/raw_streams.h"

namespace planetree::octree {

/// Unpacks the triangle blocks of one page, in their order, into records of
/// the serving layout. The counts in `streams` have been checked; everything
/// else is checked here. Each fault is one sentence's end, or null.
class BlockDecoder {
 public:
  BlockDecoder(const RawStreams& streams, const BlockShape& shape)
      : streams_(streams), shape_(shape) {}

  /// Unpacks the next block to `record`, which has the slots it needs.
  const char* decode_next(std::byte* record) noexcept;

  /// After the last block: whether every stream was used up.
  const char* finish() const noexcept;

 private:
  // Vertices of a block: some that the page has had, ascending, then the page's next ones.
  struct Vertices {
    unsigned old_count = 0;
    std::array<std::uint32_t, kMaxBlockVertices> old;
    std::size_t first_new = 0;
  };

  const char* collect_vertices(unsigned count, unsigned new_count, Vertices& vertices);
  const char* store_corners(BlockHeader& header);
  const char* store_vertices(BlockHeader& header, const Vertices& vertices);
  template <class T>
  static bool store_rows(const Shuffled<T>& page, const Vertices& vertices, unsigned count,
                         unsigned stride, T* rows);
  const char* store_ids(BlockHeader& header);
  template <class Id>
  bool store_ids(const Shuffled<Id>& firsts, const Shuffled<Id>& steps, unsigned count, Id* ids);

  const RawStreams& streams_;
  const BlockShape& shape_;
  std::size_t block_ = 0;
  std::size_t next_ref_ = 0;
  std::size_t next_vertex_ = 0;
  std::size_t next_corner_byte_ = 0;
  std::size_t next_id_step_ = 0;
};

}  // namespace planetree::octree
