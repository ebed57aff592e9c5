#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/sort/morton_order.h"
#include "octree/builder/tree/treelets.h"
#include "octree/builder/tree/wide_tree.h"
#include "octree/page/frame.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Contents of one page: indices into a WideTree, in the order of the frame.
struct PlannedPage {
  std::uint32_t number = 0;
  std::uint64_t octcode = 0;          ///< octcode of the least key of its subtrees
  std::uint32_t ordinal = 0;          ///< ordinal of that key
  std::uint16_t root_count = 0;       ///< nodes at the front that are roots of subtrees
  std::vector<std::uint32_t> nodes;   ///< roots first, then breadth first
  std::vector<std::uint32_t> blocks;  ///< as nodes refer to them
};

/// The page of every record, and its number there.
struct PagePlan {
  std::uint32_t page_bytes = 0;         ///< size of every frame
  std::vector<PlannedPage> pages;       ///< in the order of their keys
  std::vector<StoredLink> node_links;   ///< link to each wide node
  std::vector<StoredLink> block_links;  ///< link to each block
};

/// Gives a node of its own to each block of a node that does not fit in the bottom of a page
/// together with its blocks. So every subtree that begins a page has a node as its root.
void part_blocks(WideTree& tree, const RecordSlots& slots, std::uint32_t page_bytes);

/// Packs a tree into pages of `page_bytes`, after part_blocks().
///
/// Bottom subtrees of at most a quarter page are kept whole. What is left above them is cut again,
/// into subtrees of at most a page, until the root is reached. Subtrees that hang from one page
/// share pages, in Morton order; subtrees that hang from different pages do not. So a page is read
/// only after its one parent page.
///
/// errors  kBadArgument: more pages than links can address, 2^23 - 1 for pages of 64 KiB.
Result<PagePlan> plan_pages(const WideTree& tree, const std::vector<MortonKey>& keys,
                            const RecordSlots& slots, std::uint32_t page_bytes);

}  // namespace planetree::octree
