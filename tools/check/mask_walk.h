#pragma once

#include <cstdint>
#include <functional>

#include "octree/geometry/cell_grid.h"
#include "octree/page/mask_frame.h"
#include "tools/check/file_parts.h"
#include "tools/check/issue.h"
#include "tools/check/subtree_links.h"

namespace planetree::tools {

/// A grey cell as its page holds it: one of the four is not null.
struct GreyCell {
  std::uint32_t page = 0;
  octree::GridCell cell;
  const octree::MaskNode* node = nullptr;
  const octree::MaskCorners* corners = nullptr;
  const octree::MaskSpecial* special = nullptr;
  const octree::MaskListed* listed = nullptr;
  const double* planes = nullptr;  ///< of a special cell, 9 each
  octree::MaskBlocks blocks;       ///< of a listed one
};

/// Goes through the mask page by page, as pages come, and finds the cell that
/// each record is of. Records whose parent was not seen are passed over.
///
/// memory  links to pages not yet come
class MaskWalk {
 public:
  using Visitor = std::function<void(const GreyCell&)>;
  using Reporter = std::function<void(Issue)>;

  /// report  links that lead nowhere, twice to a place, or are missing.
  MaskWalk(FileParts& parts, Visitor visit, Reporter report);

  /// The page that `parts` decoded last. Pages are given in their order.
  void add(std::uint32_t page);
  /// A page that cannot be read.
  void lose(std::uint32_t page);

 private:
  /// A node in an earlier page whose family is awaited.
  struct Owner {
    octree::GridCell cell;
    octree::MaskNode node;
  };
  class Page;

  void take_roots(Page& page);
  void place_family(Page& page, const octree::MaskNode& node, const octree::GridCell& cell,
                    std::uint32_t first_slot);
  void visit_records(Page& page);
  void follow(Page& page, std::uint32_t slot, const octree::GridCell& cell);

  FileParts& parts_;
  const octree::MaskLinkFormat links_;
  const Visitor visit_;
  const Reporter report_;
  SubtreeLinks<Owner> pending_;
  bool complete_ = true;
};

}  // namespace planetree::tools
