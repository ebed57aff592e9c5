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

/// Counts of one depth of the tree. The root has depth 0.
struct LevelRow {
  std::uint64_t nodes = 0;
  std::uint64_t children = 0;  ///< children of those nodes
  std::uint64_t blocks = 0;
  std::uint64_t triangles = 0;  ///< triangles in those blocks
  /// Distance pages whose highest node or block has this depth, and their stored bytes.
  std::uint64_t pages = 0, page_bytes = 0;
};

/// Counts of the cells of one level of the mask.
struct MaskLevelRow {
  std::uint64_t white = 0;
  std::uint64_t black = 0;    ///< black and inverted cells
  std::uint64_t grey = 0;     ///< divided cells, and leaves with corners or special
  std::uint64_t corners = 0;  ///< leaves with corner numbers, listed or not
  std::uint64_t special = 0;
};

/// One page. An unreadable page has no head.
struct PageRow {
  std::uint32_t number = 0;
  storage::PageEntry entry{};
  std::optional<octree::PageHead> head;                 ///< head of a distance page or cap page
  std::optional<octree::MaskPageHead> mask;             ///< head of a mask page
  std::optional<octree::FieldPageHead> field;           ///< head of a field page
  std::optional<octree::AttributePageHead> attributes;  ///< head of an attribute page
  bool is_of_caps = false;                              ///< `head` is that of a cap page
};

/// Contents of a file, counted in one pass over its pages.
struct FileSurvey {
  IssueList issues;
  /// Sums over all pages of a kind. Empty if none can be read.
  std::vector<StreamRow> streams, cap_streams, field_streams, attribute_streams, mask_streams;
  std::uint64_t lists = 0;            ///< listed cells of the mask
  std::uint64_t height_fields = 0;    ///< blocks marked as height fields
  std::vector<LevelRow> levels;       ///< by depth
  std::vector<MaskLevelRow> mask;     ///< by level; empty without a mask
  std::uint64_t unreached_pages = 0;  ///< pages below unreadable pages, not in `levels`
};

/// Called for each page in ascending order. Returns false to end the survey.
using PageVisitor = std::function<bool(const PageRow&)>;

/// Surveys a file. Issues found on the way are listed and do not end the survey.
///
/// memory  one page and the pending links to later pages
FileSurvey survey_file(FileParts& parts, const PageVisitor& visit);

}  // namespace planetree::tools
