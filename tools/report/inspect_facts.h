#pragma once

#include <string>

#include "tools/html/html_page.h"
#include "tools/report/inspect_record.h"

namespace planetree::tools {

/// Facts of a file that has no plot: at the top of its page.
HtmlFigures inspect_facts(const InspectRecord& record);
/// How the surface is closed and sides are found, with the unbalanced edges that the file lists.
std::string surface_section(const InspectRecord& record);
/// What is damaged. Empty if nothing is.
std::string issues_section(const InspectRecord& record);

}  // namespace planetree::tools
