#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/tree/chunk_build.h"
#include "octree/builder/tree/top_tree.h"
#include "planetree/error.h"

namespace planetree::octree {

/// A page of the whole tree.
struct NumberedPage {
  static constexpr std::uint32_t kTopTree = ~std::uint32_t{0};

  std::uint64_t octcode = 0;
  std::uint32_t ordinal = 0;       ///< among pages of the same octcode
  std::uint32_t chunk = kTopTree;  ///< its chunk, or kTopTree
  std::uint32_t index = 0;         ///< among the pages of the chunk or the top tree
};

/// The pages of the top tree and of all chunks, in the order of the file, and their numbers there.
class PageNumbers {
 public:
  PageNumbers(const TopTree& top_tree, const std::vector<BuiltChunk>& chunks,
              std::uint32_t page_bytes, std::uint32_t first_page);

  /// errors  kBadArgument: more pages than links can address, 2^23 - 1 for pages of 64 KiB.
  Result<void> check() const;

  std::uint32_t size() const { return static_cast<std::uint32_t>(pages_.size()); }
  std::uint32_t first_page() const { return first_page_; }
  /// The page with a number in the file.
  const NumberedPage& page(std::uint32_t number) const { return pages_[number - first_page_]; }
  /// The number in the file of a page of the top tree.
  std::uint32_t top_tree_page(std::size_t index) const { return of_top_tree_[index]; }
  /// The number in the file of a page of a chunk.
  std::uint32_t chunk_page(std::uint32_t chunk, std::size_t index) const {
    return of_chunk_[chunk][index];
  }

 private:
  const LinkFormat links_;
  const std::uint32_t first_page_;
  std::vector<NumberedPage> pages_;
  std::vector<std::uint32_t> of_top_tree_;
  std::vector<std::vector<std::uint32_t>> of_chunk_;
};

}  // namespace planetree::octree
