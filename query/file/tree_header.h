#pragma once

#include "planetree/error.h"
#include "storage/file/file_layout.h"

namespace planetree::query {

/// Checks what a header says of the tree and what no single page can check: the root is on page 0,
/// and the distance pages have room for the stated nodes and blocks. Traversals stop after as many
/// records as the header states, so that this bounds the time of a query by the size of the file.
///
/// header  has passed storage::check_header()
/// errors  kDamaged, with the offset of the field
Result<void> check_tree_header(const storage::FileHeader& header) noexcept;

}  // namespace planetree::query
