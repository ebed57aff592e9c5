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

/// The tree of a model whose chunks are all built. Its pages are numbered as in the file. Links of
/// its nodes have numbers of records, because the number of all pages of the file is not known yet.
/// threads  any number.
class BuiltTree {
 public:
  /// All arguments must outlive this.
  /// chunks  those of `above`.
  /// file    has the pages of the chunks.
  /// first_page  number of the tree's first page in the file.
  BuiltTree(const ModelFrame& frame, const ChunkTree& above, const std::vector<BuiltChunk>& chunks,
            const BlockShape& shape, std::uint32_t page_bytes, const storage::SpillFile& file,
            std::uint32_t first_page = 0);
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
  const BlockShape shape_;
  const std::uint32_t page_bytes_;
  TopTree top_tree_;
  const PageNumbers numbers_;
  const TreePages pages_;
  std::uint64_t node_count_ = 0;
  std::uint64_t block_count_ = 0;
};

/// The trees of a model that is built but not written.
struct BuiltTrees {
  const BuiltTree* surface;
  const BuiltTree* caps;  ///< null: there are none

  // A surface without caps needs no more than its tree.
  BuiltTrees(const BuiltTree* tree,  // NOLINT(google-explicit-constructor)
             const BuiltTree* tree_of_caps = nullptr)
      : surface(tree), caps(tree_of_caps) {}

  /// Number of the pages of both, which are the first of the file.
  std::uint32_t page_count() const {
    return surface->pages().size() + (caps ? caps->pages().size() : 0);
  }
  /// Facts for traversals. `cap_info` receives those of the caps, and must outlive the result.
  TreeInfo info(TreeInfo& cap_info) const {
    TreeInfo info = surface->info();
    if (caps) {
      cap_info = caps->info();
      info.caps = &cap_info;
    }
    return info;
  }
  const BuiltTree& tree_of_page(std::uint32_t number) const {
    return surface->pages().has(number) ? *surface : *caps;
  }
};

}  // namespace planetree::octree
