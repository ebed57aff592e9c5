#include "tools/html/figure_row.h"

#include <cassert>
#include <cstddef>
#include <utility>

namespace planetree::tools {

void add_figure_row(HtmlTable& table, HtmlPage& page, const std::string& key,
                    const std::string& title, std::vector<std::string> cells) {
  assert(cells.size() == table.columns.size());
  HtmlFigures figures{title, {}};
  for (std::size_t i = 1; i < cells.size(); ++i) {
    const HtmlColumn& column = table.columns[i];
    figures.values.emplace_back(
        column.group.empty() ? column.name : column.name + " (" + column.group + ")", cells[i]);
  }
  page.figures[key] = std::move(figures);
  table.rows.push_back({key, false, {}, std::move(cells)});
}

}  // namespace planetree::tools
