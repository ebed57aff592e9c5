#pragma once

#include <string>

#include "tools/tune/tune_record.h"

namespace planetree::tools {

/// The record as an HTML page.
///
/// command  what makes the page again
[[nodiscard]] std::string tune_page(const TuneRecord& record, const std::string& command);

}  // namespace planetree::tools
