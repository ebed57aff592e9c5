#include "tools/trade/trade_figures.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/size_text.h"
#include "tools/html/html_text.h"

namespace planetree::tools {
namespace {

std::string percent_text(std::size_t count, std::size_t all) {
  return fmt::format("{:.1f} %", 100 * static_cast<double>(count) / static_cast<double>(all));
}

}  // namespace

bool is_dominated(const TradeRecord& record, const TradeRow& row, std::size_t workload) {
  const auto error = [&](const TradeRow& of) {
    return std::max(record.share(of.results[workload].promised.p99), kTradeMinShare);
  };
  const double own_error = error(row), own_seconds = row.results[workload].seconds;
  return std::any_of(record.rows.begin(), record.rows.end(), [&](const TradeRow& other) {
    if (other.setting.wait == Wait::kNever) return false;
    const double its_error = error(other), its_seconds = other.results[workload].seconds;
    return its_error <= own_error && its_seconds <= own_seconds &&
           (its_error < own_error || its_seconds < own_seconds);
  });
}

std::string key_of(const TradeRecord& record, const TradeRow& row, std::size_t workload) {
  return fmt::format("{}-{}", name_of(record.workloads[workload]), &row - record.rows.data());
}

std::vector<TradeFigure> trade_figures(const TradeRecord& record, const TradeRow& row,
                                       std::size_t workload) {
  const TradeResult& result = row.results[workload];
  const auto share = [&](double length) { return power_text(record.share(length)); };
  const std::string options = row.setting.options();
  return {{{"", "queries a second"}, short_count(per_second(result))},
          {{"", "time of exact"}, fmt::format("{:.2f}", result.ratio_to_exact)},
          {{"", "pages a query"}, fmt::format("{:.3f}", pages_per_query(result))},
          {{"promised error", "p50"}, share(result.promised.p50)},
          {{"promised error", "p99"}, share(result.promised.p99)},
          {{"promised error", "most"}, share(result.promised.most)},
          {{"true error", "p50"}, share(result.actual.p50)},
          {{"true error", "p99"}, share(result.actual.p99)},
          {{"true error", "most"}, share(result.actual.most)},
          {{"answers", "broken"}, grouped_count(result.broken)},
          {{"answers", "exact"}, percent_text(result.exact, result.points)},
          {{"answers", "degraded"}, percent_text(result.degraded, result.points)},
          {{"answers", "no side"}, percent_text(result.side_unknown, result.points)},
          {{"", "options", HtmlColumn::Kind::kCode}, options.empty() ? "none" : options}};
}

HtmlFigures named_figures(const TradeRecord& record, const TradeRow& row, std::size_t workload) {
  HtmlFigures named{fmt::format("{}, {}", name_of(row.setting, record.diagonal),
                                name_of(record.workloads[workload])),
                    {}};
  for (const TradeFigure& figure : trade_figures(record, row, workload)) {
    const auto& [group, name, kind] = figure.column;
    const std::string full = group.empty()        ? name
                             : group == "answers" ? name + " answers"
                                                  : group + " " + name;
    named.values.emplace_back(full, figure.text);
  }
  return named;
}

}  // namespace planetree::tools
