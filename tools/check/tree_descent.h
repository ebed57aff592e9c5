#pragma once

#include <cstdint>
#include <functional>

#include "octree/geometry/child_bounds.h"
#include "planetree/error.h"
#include "tools/check/file_parts.h"

namespace planetree::tools {

/// A node or a block of the tree, with the bounds that its parent has of it. Boxes and discs are in
/// the model frame, relative to the model's centre.
struct TreePart {
  std::uint32_t depth = 0;  ///< of the root: 0
  std::uint32_t page = 0;   ///< page that has it
  bool is_block = false;
  bool begins_page = false;    ///< whether its parent is in another page, or it is the root
  bool is_only_child = false;  ///< it then fills the box of its parent
  bool has_disc = false;       ///< not the root, nor where the disc states nothing
  octree::FloatBox box;
  octree::Disc disc;
};

/// Visits the tree from the root: parents before their children, and pages in ascending order.
/// Reads a page only if a part in it is to be opened.
///
/// visit     returns whether to visit the children; of no effect for a block
/// progress  called with the number of each page that is passed; may be empty
/// memory    one page, and a number for each opened part of later pages
/// errors    kDamaged: there is no header, or a page or a link cannot be read
Result<void> descend_tree(FileParts& parts, const std::function<bool(const TreePart&)>& visit,
                          const std::function<void(std::uint32_t page)>& progress);

}  // namespace planetree::tools
