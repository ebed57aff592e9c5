#pragma once

#include "tools/check/file_check.h"
#include "tools/check/file_parts.h"

namespace planetree::tools {

/// Holds the mask pages of a file against what the format promises of them.
///
/// prove   also what they say of the triangles; only of a file that is sound
///         otherwise, for it is proven by the tree.
/// report  what is found is added to it.
/// memory  one page, the links to pages not yet come, and to prove 256 MiB.
void check_mask(FileParts& parts, bool prove, CheckReport& report, const CheckProgress& progress);

}  // namespace planetree::tools
