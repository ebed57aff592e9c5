#pragma once

#include "tools/check/file_check.h"
#include "tools/check/file_parts.h"

namespace planetree::tools {

/// Proves anew that blocks are in sheets that are said to be; only of a file that is sound
/// otherwise, for it is proven by the tree and the mask.
///
/// issues  what is found is added to it.
/// memory  one page and, where any block is said to be, 256 MiB
void check_height_fields(FileParts& parts, IssueList& issues);

}  // namespace planetree::tools
