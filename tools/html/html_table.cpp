#include "tools/html/html_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "tools/html/html_text.h"

namespace planetree::tools {
namespace {

const char* class_of(const HtmlColumn& column) {
  switch (column.kind) {
    case HtmlColumn::Kind::kNumber:
      return "number";
    case HtmlColumn::Kind::kText:
      return "text";
    case HtmlColumn::Kind::kCode:
      return "code";
  }
  return "";
}

std::string heading(const HtmlTable& table) {
  const auto& columns = table.columns;
  const bool has_groups = std::any_of(columns.begin(), columns.end(),
                                      [](const HtmlColumn& c) { return !c.group.empty(); });
  std::string upper, lower;
  for (std::size_t i = 0; i < columns.size();) {
    std::size_t end = i + 1;
    if (columns[i].group.empty()) {
      upper += fmt::format(R"(<th scope="col" class="{}"{}>{}</th>)", class_of(columns[i]),
                           has_groups ? R"( rowspan="2")" : "", html_text(columns[i].name));
    } else {
      while (end < columns.size() && columns[end].group == columns[i].group) ++end;
      upper +=
          fmt::format(R"(<th scope="colgroup" class="group" colspan="{}"><span>{}</span></th>)",
                      end - i, html_text(columns[i].group));
      for (std::size_t k = i; k < end; ++k)
        lower += fmt::format(R"(<th scope="col" class="{}">{}</th>)", class_of(columns[k]),
                             html_text(columns[k].name));
    }
    i = end;
  }
  return "<thead><tr>" + upper + (has_groups ? "</tr><tr>" + lower : "") + "</tr></thead>\n";
}

std::string row_html(const HtmlRow& row, const std::vector<HtmlColumn>& columns) {
  std::string html = "<tr";
  if (!row.key.empty()) html += fmt::format(R"( data-key="{}")", html_text(row.key));
  html += row.is_muted ? R"( class="muted">)" : ">";
  for (std::size_t i = 0; i < row.cells.size(); ++i) {
    const std::string text = html_text(row.cells[i]);
    if (i == 0)
      html += fmt::format(R"(<th scope="row">{}{}</th>)", text,
                          row.is_muted ? fmt::format(R"(<span class="unseen"> ({})</span>)",
                                                     html_text(row.muted_note))
                                       : std::string());
    else if (columns[i].kind == HtmlColumn::Kind::kCode)
      html += fmt::format(R"(<td class="code"><code>{}</code></td>)", text);
    else
      html += fmt::format(R"(<td class="{}">{}</td>)", class_of(columns[i]), text);
  }
  return html + "</tr>\n";
}

}  // namespace

std::string table_html(const HtmlTable& table) {
  constexpr std::size_t kMaxRowsInFull = 24;
  std::string html =
      fmt::format(R"(<p class="caption">{0}</p>)"
                  "\n"
                  R"(<div class="scroll{1}" tabindex="0" role="region" aria-label="{0}"><table>)"
                  "\n",
                  html_text(table.caption), table.rows.size() > kMaxRowsInFull ? " tall" : "");
  html += heading(table) + "<tbody>\n";
  for (const HtmlRow& row : table.rows) html += row_html(row, table.columns);
  return html + "</tbody></table></div>\n";
}

}  // namespace planetree::tools
