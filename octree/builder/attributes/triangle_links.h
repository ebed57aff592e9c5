#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "octree/page/frame.h"
#include "planetree/error.h"
#include "storage/spill/spill_buckets.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// The numbered links (LinkFormat) of the blocks that have the triangles of a file, sorted by
/// triangle index. They are collected in buckets of successive indices, each of which fits in
/// memory.
class TriangleLinks {
 public:
  /// Bytes of a triangle in a bucket.
  static constexpr std::size_t kTriangleBytes = 8;

  /// index_count  indices of the mesh, at least 1.
  /// in_page      indices of an attribute page; a bucket has those of whole pages.
  /// shape        of the tree's blocks.
  /// file         receives what does not fit in memory; must outlive this.
  TriangleLinks(std::uint64_t index_count, std::uint32_t in_page, const BlockShape& shape,
                std::uint32_t page_bytes, storage::SpillFile& file);

  /// Adds the triangles of a distance page.
  ///
  /// number   page number in the file.
  /// raw      raw bytes of the page, as the encoder made them.
  /// errors   those of SpillFile::append().
  /// threads  any number.
  Result<void> add(std::uint32_t number, std::span<const std::byte> raw);

  /// Number of attribute pages whose triangles are in one bucket; the last may have fewer.
  std::uint32_t pages_per_bucket() const { return pages_per_bucket_; }
  /// Reads the links of a bucket: one for each of its indices, kNoLink where no block has it. Call
  /// it after the last add().
  /// errors  those of SpillFile::read().
  Result<std::vector<std::uint32_t>> links(std::uint32_t bucket);

 private:
  Result<void> add_block(std::uint32_t link, std::span<const std::uint64_t> indices);

  const std::uint64_t index_count_;
  const BlockShape shape_;
  const LinkFormat format_;
  const std::uint32_t pages_per_bucket_;
  const std::uint64_t bucket_indices_;
  std::mutex adding_;
  storage::SpillBuckets buckets_;
};

}  // namespace planetree::octree
