#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "octree/builder/tree/chunk_build.h"
#include "octree/builder/tree/page_appender.h"
#include "octree/builder/tree/page_numbers.h"
#include "octree/builder/tree/top_tree.h"
#include "octree/geometry/child_bounds.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// The raw bytes of a file's distance pages, by page number: the spilled pages of the chunks, with
/// the links of the whole tree, and the pages of the top tree.
/// threads  any number.
class TreePages {
 public:
  /// All arguments must outlive this. Sets the links in `top_tree`.
  TreePages(TopTree& top_tree, const std::vector<BuiltChunk>& chunks, const PageNumbers& numbers,
            const BlockShape& shape, const storage::SpillFile& file);

  std::uint32_t size() const { return numbers_.size(); }
  std::uint32_t first() const { return numbers_.first_page(); }
  /// Whether a page of the file is one of these.
  bool has(std::uint32_t number) const { return number - first() < size(); }
  /// number  in the file.
  Result<FilePage> encode(std::uint32_t number) const;
  /// Returns a box, relative to the model's centre, that contains the triangles of the pages from
  /// `first` to before `end`, numbers in the file of any pages. Empty if none has triangles.
  std::optional<FloatBox> box_of(std::uint32_t first, std::uint32_t end) const;

 private:
  const TopTree& top_tree_;
  const std::vector<BuiltChunk>& chunks_;
  const PageNumbers& numbers_;
  const BlockShape& shape_;
  const storage::SpillFile& file_;
};

}  // namespace planetree::octree
