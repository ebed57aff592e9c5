#pragma once

#include "tools/check/file_check.h"
#include "tools/check/file_parts.h"

namespace planetree::tools {

/// Checks the field pages, and counts them in the report.
///
/// prove  also searches the tree for the surface point nearest to each grid point
void check_field(FileParts& parts, bool prove, CheckReport& report, const CheckProgress& progress);

}  // namespace planetree::tools
