#pragma once

#include "tools/check/file_check.h"
#include "tools/check/file_parts.h"

namespace planetree::tools {

/// Checks the mask pages of a file against the rules of the format.
///
/// prove   checks the mask's statements against the triangles too; this uses the tree, so that the
///         file must have no other issue
/// report  issues and counts found are added
/// memory  one page, the pending links to later pages, and 256 MiB to prove
void check_mask(FileParts& parts, bool prove, CheckReport& report, const CheckProgress& progress);

}  // namespace planetree::tools
