#pragma once

#include <cstdint>
#include <functional>

#include "octree/geometry/cell_grid.h"
#include "octree/page/mask_frame.h"
#include "tools/check/file_parts.h"
#include "tools/check/issue.h"
#include "tools/check/subtree_links.h"

namespace planetree::tools {

/// A grey cell and its record. Exactly one of node, corners, special and listed is not null.
struct GreyCell {
  std::uint32_t page = 0;
  octree::GridCell cell;
  const octree::MaskNode* node = nullptr;
  const octree::MaskCorners* corners = nullptr;
  const octree::MaskSpecial* special = nullptr;
  const octree::MaskListed* listed = nullptr;
  const double* planes = nullptr;  ///< planes of a special cell, 9 numbers each
  octree::MaskBlocks blocks;       ///< list of a listed cell
};

/// Visits the records of the mask page by page, in the order of pages, and finds each record's
/// cell. Skips records whose parent was not seen.
///
/// memory  pending links to later pages
class MaskWalk {
 public:
  using Visitor = std::function<void(const GreyCell&)>;
  using Reporter = std::function<void(Issue)>;

  /// parts   must outlive this
  /// visit   called for each record
  /// report  called for links that lead to no family, lead to a family twice, or are missing
  MaskWalk(FileParts& parts, Visitor visit, Reporter report);

  /// Visits the page that `parts` decoded last. Pages must be added in ascending order.
  void add(std::uint32_t page);
  /// Records that a page cannot be read.
  void skip_page(std::uint32_t page);

 private:
  /// A node in an earlier page whose family is in a later one.
  struct FamilyParent {
    octree::GridCell cell;
    octree::MaskNode node;
  };
  class Page;

  void take_roots(Page& page);
  void assign_cells(Page& page, const octree::MaskNode& node, const octree::GridCell& cell,
                    std::uint32_t first);
  void visit_records(Page& page);
  void visit_record(Page& page, std::uint32_t number, const octree::GridCell& cell);

  FileParts& parts_;
  const octree::MaskLinkFormat links_;
  const Visitor visit_;
  const Reporter report_;
  SubtreeLinks<FamilyParent> pending_;
  bool complete_ = true;
};

}  // namespace planetree::tools
