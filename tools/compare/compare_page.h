#pragma once

#include <string>

#include "tools/compare/compare_record.h"

namespace planetree::tools {

/// The record as an HTML file.
///
/// command  that makes the page again, as typed in a shell
[[nodiscard]] std::string compare_page(const CompareRecord& record, const std::string& command);

}  // namespace planetree::tools
