#pragma once

#include <filesystem>
#include <string>

#include "tools/report/inspect_record.h"

namespace planetree::tools {

/// The report about a file as one HTML file: facts and issues, bytes by part, tree and mask by
/// level, pages. A damaged file has what can be read of it. The size of the page is bounded.
///
/// command  what makes the page again, see inspect_command()
std::string inspect_page(const InspectRecord& record, const std::string& command);

/// The command that makes the page `html` of a file, as typed in a shell.
std::string inspect_command(const std::filesystem::path& file, const std::filesystem::path& html);

}  // namespace planetree::tools
