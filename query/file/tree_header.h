#pragma once

#include "planetree/error.h"
#include "storage/file/file_layout.h"

namespace planetree::query {

/// Checks that links in memory, of 32 bits, can lead to all pages of the trees and of the mask.
///
/// header  its page size is one of a file
/// errors  kUnsupported
Result<void> check_page_limits(const storage::FileHeader& header) noexcept;

/// Checks what a header says of the tree and what no single page can check: the pages are within
/// check_page_limits() and have room for the stated nodes and blocks. Traversals stop after as many
/// records as the header states, so that this bounds the time of a query by the size of the file.
///
/// header  has passed storage::check_header()
/// errors  kDamaged, with the offset of the field; kUnsupported
Result<void> check_tree_header(const storage::FileHeader& header) noexcept;

}  // namespace planetree::query
