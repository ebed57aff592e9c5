#include "tools/trade/trade_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/shell_word.h"
#include "tools/cli/size_text.h"
#include "tools/html/html_page.h"
#include "tools/html/html_text.h"
#include "tools/trade/trade_figures.h"
#include "tools/trade/trade_plots.h"

namespace planetree::tools {
namespace {

constexpr const char* kDominated = "dominated";

HtmlFigures facts(const TradeRecord& record) {
  HtmlFigures facts{"model", {}};
  facts.values.emplace_back("triangles", grouped_count(record.triangles));
  facts.values.emplace_back("diagonal", number_text(record.diagonal));
  if (record.median_edge > 0)
    facts.values.emplace_back("median edge",
                              fmt::format("{} ({} diagonals)", number_text(record.median_edge),
                                          number_text(record.share(record.median_edge))));
  facts.values.emplace_back("memory of the whole model", short_bytes(record.whole_bytes));
  return facts;
}

const char* heading_of(TradeWorkload workload) {
  switch (workload) {
    case TradeWorkload::kUniform:
      return "Uniform points";
    case TradeWorkload::kNear:
      return "Points near the surface";
    case TradeWorkload::kPath:
      return "Points on a path";
    case TradeWorkload::kGiven:
      return "Given points";
  }
  return "";
}

const char* where_of(TradeWorkload workload) {
  switch (workload) {
    case TradeWorkload::kUniform:
      return "anywhere in the box around the model";
    case TradeWorkload::kNear:
      return "within 0.1 % of the diagonal of the surface, all over it";
    case TradeWorkload::kPath:
      return "one behind the other along the surface";
    case TradeWorkload::kGiven:
      return "those of the given file, in order";
  }
  return "";
}

/// A row of a table: its heading, then the setting's figures.
HtmlRow row_of(const TradeRecord& record, const TradeRow& row, std::size_t workload,
               std::vector<std::string> headings) {
  HtmlRow made;
  made.key = key_of(record, row, workload);
  made.cells = std::move(headings);
  for (TradeFigure& figure : trade_figures(record, row, workload))
    made.cells.push_back(std::move(figure.text));
  return made;
}

void add_columns(const TradeRecord& record, HtmlTable& table) {
  for (TradeFigure& figure : trade_figures(record, record.rows.front(), 0))
    table.columns.push_back(std::move(figure.column));
}

std::string workload_section(const TradeRecord& record, std::size_t workload) {
  const TradeResult& exact = record.rows.front().results[workload];
  HtmlTable table{
      "Figures of both plots. Errors are shares of the diagonal. Grey rows are "
      "dominated: another promises no more in no more time.",
      {{"", "setting", HtmlColumn::Kind::kText}},
      {}};
  add_columns(record, table);
  for (const TradeRow& row : record.rows) {
    if (row.setting.wait == Wait::kNever) continue;
    table.rows.push_back(row_of(record, row, workload, {name_of(row.setting, record.diagonal)}));
    table.rows.back().is_muted = is_dominated(record, row, workload);
    table.rows.back().muted_note = kDominated;
  }
  return section_html(heading_of(record.workloads[workload]),
                      paragraph_html(fmt::format("{} points, {}.", grouped_count(exact.points),
                                                 where_of(record.workloads[workload]))) +
                          row_of_plots_html(plot_html(rate_plot(record, workload)) +
                                            plot_html(pages_plot(record, workload))) +
                          table_html(table));
}

std::string paced_section(const TradeRecord& record) {
  std::string html = paragraph_html(
      "A query every millisecond that never waits for pages, in a model of which none is in memory "
      "at the start. Pages that were missing come for the next queries. The rate is that of the "
      "processor time of the queries.");
  for (const std::uint64_t bytes : record.too_small)
    html += paragraph_html(
        fmt::format("Not measured within {}: the model needs more memory.", short_bytes(bytes)));
  HtmlTable table{"Figures of both plots. Errors are shares of the diagonal.",
                  {{"", "points", HtmlColumn::Kind::kText}, {"", "memory"}},
                  {}};
  add_columns(record, table);
  for (std::size_t i = 0; i < record.workloads.size(); ++i)
    for (const TradeRow& row : record.rows)
      if (row.setting.wait == Wait::kNever)
        table.rows.push_back(row_of(
            record, row, i, {name_of(record.workloads[i]), short_bytes(row.setting.memory_bytes)}));
  if (!table.rows.empty())
    html += row_of_plots_html(plot_html(width_plot(record)) + plot_html(degraded_plot(record))) +
            table_html(table);
  return section_html("Without waiting, in little memory", html);
}

std::string query_command(const TradeRecord& record, const TradeSetting& setting) {
  const std::string options = setting.options();
  return "planetree query " + shell_word(record.file) + " POINTS" +
         (options.empty() ? "" : " " + options);
}

HtmlRow recommendation(const TradeRecord& record, const TradeGoal& goal, const TradeRow& row) {
  const std::string options = row.setting.options();
  HtmlRow made;
  made.cells = {goal.name, number_text(goal.max_error), options.empty() ? "none: exact" : options};
  for (const TradeResult& result : row.results)
    made.cells.push_back(short_count(per_second(result)));
  const TradeOverall all = overall(row);
  made.cells.push_back(fmt::format("{:.2f}", row.ratio_to_exact()));
  made.cells.push_back(power_text(record.share(all.actual_p99)));
  made.cells.push_back(fmt::format("{} of {}", all.broken, grouped_count(all.points)));
  return made;
}

std::string recommendations(const TradeRecord& record) {
  HtmlTable table{
      "The cheapest options that promise the error at every point, not only at those "
      "measured. The true error is the share of the diagonal in the worst workload.",
      {{"", "for an error of at most", HtmlColumn::Kind::kText},
       {"", "model units"},
       {"", "options", HtmlColumn::Kind::kCode}},
      {}};
  for (const TradeWorkload workload : record.workloads)
    table.columns.push_back({"queries a second", name_of(workload)});
  table.columns.insert(table.columns.end(),
                       {{"", "time of exact"}, {"", "true error p99"}, {"", "broken"}});
  for (const TradeGoal& goal : trade_goals(record))
    if (const TradeRow* row = choose(record.rows, goal.max_error))
      table.rows.push_back(recommendation(record, goal, *row));
  if (table.rows.empty()) return paragraph_html("No setting keeps an error.");
  return table_html(table);
}

std::string commands(const TradeRecord& record, const std::string& command) {
  std::string html;
  for (const TradeGoal& goal : trade_goals(record))
    if (const TradeRow* row = choose(record.rows, goal.max_error))
      html += command_html(fmt::format("For an error of at most {}", goal.name),
                           query_command(record, row->setting));
  return section_html("Commands", html + command_html("To make this page again", command));
}

}  // namespace

std::string trade_page(const TradeRecord& record, const std::string& command) {
  HtmlPage page;
  page.kind = "planetree trade: what accuracy costs";
  page.title = record.file;
  page.body =
      facts_html(facts(record)) + section_html("Recommended options", recommendations(record));
  for (std::size_t i = 0; i < record.workloads.size(); ++i)
    page.body += workload_section(record, i);
  page.body += paced_section(record) + commands(record, command);
  for (const TradeRow& row : record.rows)
    for (std::size_t i = 0; i < record.workloads.size(); ++i)
      page.figures[key_of(record, row, i)] = named_figures(record, row, i);
  return page_html(page);
}

}  // namespace planetree::tools
