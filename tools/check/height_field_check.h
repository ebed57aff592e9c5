#pragma once

#include "tools/check/file_check.h"
#include "tools/check/file_parts.h"

namespace planetree::tools {

/// Proves that the blocks that are marked as height fields are height fields. The proof uses tree
/// and mask, so that the file must have no other issue.
///
/// issues  issues found are added
/// memory  one page and, if any block is marked, 256 MiB
void check_height_fields(FileParts& parts, IssueList& issues);

}  // namespace planetree::tools
