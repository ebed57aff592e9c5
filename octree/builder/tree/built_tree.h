#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/job/model_frame.h"
#include "octree/builder/sort/chunks.h"
#include "octree/builder/tree/chunk_build.h"
#include "octree/builder/tree/page_numbers.h"
#include "octree/builder/tree/top_tree.h"
#include "octree/builder/tree/tree_pages.h"
#include "octree/page/page_decoder.h"
#include "octree/traversal/tree_view.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// The tree of a model whose chunks are all built. Its pages are numbered as in the file.
/// threads  any number.
class BuiltTree {
 public:
  /// All arguments must outlive this.
  /// chunks  those of `above`.
  /// file    has the pages of the chunks.
  BuiltTree(const ModelFrame& frame, const ChunkTree& above, const std::vector<BuiltChunk>& chunks,
            const BlockShape& shape, std::uint32_t page_bytes, const storage::SpillFile& file);
  BuiltTree(const BuiltTree&) = delete;
  BuiltTree& operator=(const BuiltTree&) = delete;

  /// errors  those of PageNumbers.
  Result<void> check() const { return numbers_.check(); }

  const TreePages& pages() const { return pages_; }
  std::uint64_t node_count() const { return node_count_; }
  std::uint64_t block_count() const { return block_count_; }
  unsigned height() const;

  /// Facts of the tree for traversals, without a sample.
  TreeInfo info() const;
  /// Facts that decoding one of its pages needs.
  PageInfo info_of_page(std::uint32_t number) const;

 private:
  const ModelFrame& frame_;
  const std::vector<BuiltChunk>& chunks_;
  const BlockShape& shape_;
  const std::uint32_t page_bytes_;
  TopTree top_tree_;
  const PageNumbers numbers_;
  const TreePages pages_;
  std::uint64_t node_count_ = 0;
  std::uint64_t block_count_ = 0;
};

}  // namespace planetree::octree
