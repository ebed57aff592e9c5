#pragma once

#include <string>
#include <vector>

#include "tools/html/html_page.h"
#include "tools/html/html_table.h"

namespace planetree::tools {

/// Adds a row to a table, and the same as the figures that the page shows for what carries its key.
///
/// title  of the figures
/// cells  as the table's columns; the first names the row
void add_figure_row(HtmlTable& table, HtmlPage& page, const std::string& key,
                    const std::string& title, std::vector<std::string> cells);

}  // namespace planetree::tools
