#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "octree/page/mask_streams.h"
#include "octree/page/page_streams.h"
#include "storage/file/file_layout.h"
#include "tools/check/file_check.h"
#include "tools/check/file_parts.h"
#include "tools/report/stream_rows.h"

namespace planetree::tools {

/// All that lies at one depth of the tree; the root is at depth 0.
struct LevelRow {
  std::uint64_t nodes = 0;
  std::uint64_t children = 0;  ///< of those nodes
  std::uint64_t blocks = 0;
  std::uint64_t triangles = 0;  ///< in those blocks
};

/// All cells of one level of the mask.
struct MaskLevelRow {
  std::uint64_t white = 0;
  std::uint64_t black = 0;    ///< of positive or negative winding number
  std::uint64_t grey = 0;     ///< divided, with corners, and special ones together
  std::uint64_t corners = 0;  ///< with a list of blocks or without
  std::uint64_t special = 0;
};

/// One page. What a page that cannot be read holds is not known.
struct PageRow {
  std::uint32_t number = 0;
  storage::PageEntry entry{};
  std::optional<octree::PageHead> head;      ///< of a distance page
  std::optional<octree::MaskPageHead> mask;  ///< of a mask page
};

/// What is in a file, counted by walking its pages once.
struct FileSurvey {
  IssueList issues;
  /// Sums over all pages of either kind; empty if none can be read.
  std::vector<StreamRow> streams, mask_streams;
  std::uint64_t lists = 0;            ///< cells of the mask that list blocks
  std::uint64_t height_fields = 0;    ///< blocks that are in one
  std::vector<LevelRow> levels;       ///< by depth
  std::vector<MaskLevelRow> mask;     ///< by level; empty without a mask
  std::uint64_t unwritten_pages = 0;  ///< that hang from what cannot be read, so not in `levels`
};

/// Shown each page in its order; false ends the walk.
using PageVisitor = std::function<bool(const PageRow&)>;

/// memory  one page and the links to pages not yet come
FileSurvey survey_file(FileParts& parts, const PageVisitor& visit);

}  // namespace planetree::tools
