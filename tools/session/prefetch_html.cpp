#include "tools/session/prefetch_html.h"

#include <fmt/format.h>

#include "tools/cli/size_text.h"
#include "tools/html/html_page.h"
#include "tools/html/html_table.h"
#include "tools/html/html_text.h"

namespace planetree::tools {

std::string prefetch_section(const PrefetchFigures& figures) {
  if (figures.read == 0)
    return section_html("Prefetch", paragraph_html("No page was read for a motion."));
  HtmlTable table{"As recorded.",
                  {{"", "figure", HtmlColumn::Kind::kText},
                   {"", "value"},
                   {"", "what it is", HtmlColumn::Kind::kText}},
                  {}};
  const auto add = [&](const char* name, double share, const char* meaning) {
    table.rows.push_back({"", false, "", {name, number_text(100 * share) + " %", meaning}});
  };
  add("accuracy", figures.accuracy(), "of the pages read, those that a query found");
  add("coverage", figures.coverage(), "of the pages needed, those that had been read before");
  add("timeliness", figures.timeliness(), "of the pages used, those that arrived in time");
  add("waste", figures.waste(), "of the pages read, those that were evicted unused");
  return section_html("Prefetch", paragraph_html(fmt::format("{} pages were read for a motion.",
                                                             grouped_count(figures.read))) +
                                      table_html(table));
}

}  // namespace planetree::tools
