#pragma once

#include <string>

#include "tools/html/html_page.h"
#include "tools/report/inspect_record.h"

/// Sections of a page about a file: plots with tables. Each adds the figures of what it draws to
/// the page.
namespace planetree::tools {

/// Bytes of the parts of the file, and of what is within its pages.
std::string bytes_section(const InspectRecord& record, HtmlPage& page);
/// The least budget, and what each layer takes.
std::string memory_section(const InspectRecord& record);
/// The tree by depth.
std::string tree_section(const InspectRecord& record, HtmlPage& page);
/// The mask by level. Empty without a mask.
std::string mask_section(const InspectRecord& record, HtmlPage& page);
/// Pages by size, and compression along the file.
std::string pages_section(const InspectRecord& record, HtmlPage& page);

}  // namespace planetree::tools
