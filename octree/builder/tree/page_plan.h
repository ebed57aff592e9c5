#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/sort/morton_order.h"
#include "octree/builder/tree/treelets.h"
#include "octree/builder/tree/wide_tree.h"
#include "octree/page/frame.h"
#include "planetree/error.h"

namespace planetree::octree {

/// What one page holds: indices into a WideTree, in the order of the frame.
struct PlannedPage {
  std::uint32_t number = 0;
  std::uint64_t octcode = 0;  ///< key of its first subtree, with ...
  std::uint32_t ordinal = 0;  ///< ... the ordinal within that cell
  std::uint16_t root_node_count = 0;
  std::uint16_t root_block_count = 0;
  std::vector<std::uint32_t> nodes;   ///< roots first, then breadth first
  std::vector<std::uint32_t> blocks;  ///< roots first, then as nodes name them
};

/// Which page every record goes to, and where in its frame.
struct PagePlan {
  std::uint32_t page_bytes = 0;            ///< of every frame
  std::vector<PlannedPage> pages;          ///< by their keys
  std::vector<std::uint32_t> node_links;   ///< of each wide node
  std::vector<std::uint32_t> block_links;  ///< of each block
};

/// Packs a tree into pages of `page_bytes`.
///
/// Bottom subtrees of at most a quarter page are kept whole; what is left above
/// them is cut again, into subtrees of at most a page, until the root is
/// reached. Subtrees that hang from one page share pages, in Morton order, and
/// no others: so a page is read only after its one parent page.
///
/// errors  kBadArgument when links of 31 bits cannot tell so many pages apart:
///         2^21 of 64 KiB.
Result<PagePlan> plan_pages(const WideTree& tree, const std::vector<MortonKey>& keys,
                            const RecordSlots& slots, std::uint32_t page_bytes);

}  // namespace planetree::octree
