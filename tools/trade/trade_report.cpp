#include "tools/trade/trade_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/cli/layer_option.h"
#include "tools/cli/parts_option.h"
#include "tools/cli/size_text.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string table_row(const TradeRow& row, std::size_t workload, const TradeRecord& record) {
  const TradeResult& result = row.results[workload];
  const bool dominated =
      std::any_of(record.rows.begin(), record.rows.end(),
                  [&](const TradeRow& other) { return row.is_dominated_by(other); });
  return fmt::format(
      "  {:<20}{:>9}{:>8.2f}{:>8.3f}  {:>8.1e}{:>9.1e}  {:>8.1e}{:>9.1e}{:>8}{:>8}{}\n",
      name_of(row.setting, record.diagonal), short_count(per_second(result)), result.ratio_to_exact,
      pages_per_query(result), record.share(result.promised.p50), record.share(result.promised.p99),
      record.share(result.actual.p50), record.share(result.actual.p99), result.broken,
      result.side_unknown, dominated ? "  -" : "");
}

std::string table(const TradeRecord& record, std::size_t workload) {
  std::string text =
      fmt::format("\n{}, {} points\n  {:<20}{:>9}{:>8}{:>8}  {:>17}  {:>17}{:>8}{:>8}\n",
                  name_of(record.workloads[workload]),
                  grouped_count(record.rows.front().results[workload].points), "", "queries",
                  "time of", "pages", "promised error", "true error", "broken", "no side");
  text += fmt::format("  {:<20}{:>9}{:>8}{:>8}  {:>8}{:>9}  {:>8}{:>9}\n", "", "a second", "exact",
                      "a query", "p50", "p99", "p50", "p99");
  for (const TradeRow& row : record.rows) text += table_row(row, workload, record);
  return text;
}

std::string recommendation(const TradeGoal& goal, const TradeRow* row) {
  if (!row) return fmt::format("  {:<24}no setting keeps it\n", goal.name);
  const std::string options = row->setting.options();
  const TradeOverall all = overall(*row);
  return fmt::format(
      "  {:<24}{:<24}  {:.2f} of the time of exact answers; true error p99 {:.2g}; "
      "broken {} of {}\n",
      goal.name, options.empty() ? "exact answers" : options, row->ratio_to_exact(), all.actual_p99,
      all.broken, grouped_count(all.points));
}

Json json_of(const TradeSetting& setting) {
  return {
      {"max_error", setting.max_error},
      {"max_work", setting.max_work == QueryOptions::kNoLimit ? Json() : Json(setting.max_work)},
      {"memory_bytes", setting.memory_bytes},
      {"wait", setting.wait == Wait::kNever ? "never" : "for_pages"}};
}

Json json_of(const TradeRow& row, std::size_t workload, const TradeRecord& record) {
  const TradeResult& result = row.results[workload];
  const double points = static_cast<double>(result.points);
  return {{"workload", name_of(record.workloads[workload])},
          {"options", json_of(row.setting)},
          {"layers", layer_words(record.layers)},
          {"parts", part_words(record.parts)},
          {"points", result.points},
          {"queries_per_second", per_second(result)},
          {"ratio_to_exact", result.ratio_to_exact},
          {"pages_per_query", pages_per_query(result)},
          {"promised_p50", result.promised.p50},
          {"promised_p99", result.promised.p99},
          {"promised_max", result.promised.most},
          {"true_p50", result.actual.p50},
          {"true_p99", result.actual.p99},
          {"true_max", result.actual.most},
          {"broken", result.broken},
          {"side_unknown", result.side_unknown},
          {"side_wrong", result.side_wrong},
          {"exact_share", static_cast<double>(result.exact) / points},
          {"degraded_share", static_cast<double>(result.degraded) / points}};
}

}  // namespace

std::string trade_words(const TradeRecord& record) {
  std::string text = fmt::format(
      "{}: {} triangles, diagonal {:.6g}, median edge {:.3g}{}\n"
      "Errors in the tables are shares of the diagonal. Rows marked - are no better in "
      "time or promised error than another.\n",
      record.file, grouped_count(record.triangles), record.diagonal, record.median_edge,
      (record.layers == record.file_layers ? "" : ", layers " + layers_text(record.layers)) +
          (record.parts == kAllParts ? "" : ", parts " + parts_text(record.parts)));
  for (std::size_t i = 0; i < record.workloads.size(); ++i) text += table(record, i);
  for (const std::uint64_t bytes : record.too_small)
    text +=
        fmt::format("\nnot measured within {}: the model needs more memory\n", short_bytes(bytes));
  text += "\nFor an error of at most\n";
  const TradeRow* last = nullptr;
  for (const TradeGoal& goal : trade_goals(record)) {
    const TradeRow* row = choose(record.rows, goal.max_error);
    text += recommendation(goal, row);
    if (row) last = row;
  }
  if (last)
    text += fmt::format(
        "\nplanetree query {} POINTS{}{}{}{}\n", record.file,
        record.layers == record.file_layers ? "" : " --layers " + layers_text(record.layers),
        record.parts == kAllParts ? "" : " --parts " + parts_text(record.parts),
        last->setting.is_exact() ? "" : " ", last->setting.options());
  return text;
}

std::string trade_json(const TradeRecord& record) {
  Json rows = Json::array(), recommended = Json::array();
  for (const TradeRow& row : record.rows)
    for (std::size_t i = 0; i < record.workloads.size(); ++i)
      rows.push_back(json_of(row, i, record));
  for (const TradeGoal& goal : trade_goals(record))
    if (const TradeRow* row = choose(record.rows, goal.max_error))
      recommended.push_back({{"max_error", goal.max_error},
                             {"options", json_of(row->setting)},
                             {"ratio_to_exact", row->ratio_to_exact()}});
  return json_line({{"file", record.file},
                    {"triangles", record.triangles},
                    {"diagonal", record.diagonal},
                    {"median_edge", record.median_edge},
                    {"rows", rows},
                    {"recommended", recommended}});
}

}  // namespace planetree::tools
