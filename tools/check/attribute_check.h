#pragma once

#include "tools/check/file_check.h"
#include "tools/check/file_parts.h"

namespace planetree::tools {

/// Checks the attribute pages, and counts them in the report.
///
/// prove  also follows the link of every index to the block that must have its triangle
void check_attributes(FileParts& parts, bool prove, CheckReport& report,
                      const CheckProgress& progress);

}  // namespace planetree::tools
