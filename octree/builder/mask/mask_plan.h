#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/mask/mask_tree.h"
#include "octree/geometry/cell_grid.h"
#include "octree/page/link.h"

namespace planetree::octree {

/// Contents of one mask page: entries of a MaskTree, in the order of the frame.
struct PlannedMaskPage {
  std::uint32_t number = 0;      ///< within the mask
  std::uint64_t octcode = 0;     ///< key: least octcode of the cells that root families divide
  std::uint32_t ordinal = 0;     ///< always 0: such cells are distinct
  std::uint32_t root_count = 0;  ///< number of root entries: families of nodes in other pages
  std::vector<std::uint32_t> entries;  ///< roots, then families in the order of their nodes
};

struct MaskPlan {
  std::uint32_t page_bytes = 0;        ///< size of every frame
  std::vector<PlannedMaskPage> pages;  ///< in the order of their keys
  /// Link to the family of each entry that is a node; its page is the one within the mask. The
  /// family of a root that is apart is the first of the first page.
  std::vector<StoredLink> families;
};

/// The cell that a mask is of, and whether the root's own entry is in a page of another mask.
struct MaskRoot {
  GridCell cell;
  bool apart = false;
};

/// Packs a mask into pages of `page_bytes`. Families that hang from one page share pages, in whole
/// subtrees where these fit; families that hang from different pages do not. So a page is read only
/// after its one parent page.
MaskPlan plan_mask(const MaskTree& mask, std::uint32_t page_bytes, const MaskRoot& root = {});

}  // namespace planetree::octree
