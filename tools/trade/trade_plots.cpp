#include "tools/trade/trade_plots.h"

#include <fmt/format.h>

#include "tools/cli/size_text.h"
#include "tools/html/html_text.h"
#include "tools/trade/trade_figures.h"

namespace planetree::tools {
namespace {

constexpr const char* kErrorTitle = "promised error p99, in diagonals";
constexpr double kMinRate = 1e-3, kMinPages = 1e-6;
/// Space between the points of two workloads within the same memory, in units of the drawing.
constexpr double kBetweenWorkloads = 20;

enum Kind : std::size_t { kExact, kWithinError, kWithinWork };
const std::vector<PlotSeries> kKinds = {{"exact", PlotShape::kDiamond},
                                        {"allowed error", PlotShape::kCircle},
                                        {"limit of work", PlotShape::kSquare}};

Kind kind_of(const TradeSetting& setting) {
  if (setting.max_work != QueryOptions::kNoLimit) return kWithinWork;
  return setting.max_error > 0 ? kWithinError : kExact;
}

bool waits(const TradeRow& row) { return row.setting.wait == Wait::kForPages; }

/// "1.00 M" as "1 M".
std::string tick_count(double count) {
  std::string text = short_count(count);
  const std::size_t end = std::min(text.find(' '), text.size());
  std::string digits = text.substr(0, end);
  while (digits.find('.') != std::string::npos && (digits.back() == '0' || digits.back() == '.'))
    digits.pop_back();
  return digits + text.substr(end);
}

PlotAxis error_axis(const TradeRecord& record, const char* title, bool waiting) {
  std::vector<double> shares;
  for (const TradeRow& row : record.rows)
    if (waits(row) == waiting)
      for (const TradeResult& result : row.results) {
        shares.push_back(record.share(result.promised.p99));
        if (!waiting) shares.push_back(record.share(result.promised.p50));
      }
  return PlotAxis::logarithmic(title, shares, kTradeMinShare, short_power_text);
}

/// A plot of the settings that wait: `value` of a result against its promised error.
SvgPlot waiting_plot(const TradeRecord& record, std::size_t workload,
                     double (*value)(const TradeResult&)) {
  SvgPlot plot;
  plot.x = error_axis(record, kErrorTitle, true);
  if (record.median_edge > 0)
    plot.upper_x = plot.x.in_units_of(record.median_edge / record.diagonal, "in median edges",
                                      short_power_text);
  plot.series = kKinds;
  for (const TradeRow& row : record.rows) {
    if (!waits(row)) continue;
    const TradeResult& result = row.results[workload];
    PlotPoint point;
    point.x = record.share(result.promised.p99);
    point.y = value(result);
    point.series = kind_of(row.setting);
    point.key = key_of(record, row, workload);
    point.is_muted = is_dominated(record, row, workload);
    if (!point.is_muted) point.label = name_of(row.setting, record.diagonal);
    plot.points.push_back(point);
  }
  plot.muted_note = "dominated by another";
  return plot;
}

std::vector<double> values_of(const SvgPlot& plot) {
  std::vector<double> values;
  for (const PlotPoint& point : plot.points) values.push_back(point.y);
  return values;
}

/// A plot with a place for each memory budget and, beside each other, a point a workload.
template <class MakePoint>
SvgPlot paced_plot(const TradeRecord& record, const MakePoint& make_point) {
  SvgPlot plot;
  std::vector<std::string> budgets;
  for (const TradeRow& row : record.rows) {
    if (waits(row)) continue;
    const std::uint64_t bytes = row.setting.memory_bytes;
    for (std::size_t i = 0; i < record.workloads.size(); ++i) {
      PlotPoint point;
      point.x = static_cast<double>(budgets.size());
      point.series = i;
      point.key = key_of(record, row, i);
      point.shift = kBetweenWorkloads * (static_cast<double>(i) -
                                         (static_cast<double>(record.workloads.size()) - 1) / 2);
      make_point(row.results[i], point, plot.points);
    }
    budgets.push_back(
        fmt::format("{} ({:.0f} %)", short_bytes(bytes),
                    100 * static_cast<double>(bytes) / static_cast<double>(record.whole_bytes)));
  }
  plot.x = PlotAxis::named("memory (share of what holds the whole model)", budgets);
  constexpr PlotShape kShapes[] = {PlotShape::kCircle, PlotShape::kSquare, PlotShape::kTriangle};
  for (std::size_t i = 0; i < record.workloads.size(); ++i)
    plot.series.push_back({name_of(record.workloads[i]), kShapes[i % std::size(kShapes)]});
  return plot;
}

}  // namespace

SvgPlot rate_plot(const TradeRecord& record, std::size_t workload) {
  SvgPlot plot = waiting_plot(record, workload, per_second);
  const std::string name = name_of(record.workloads[workload]);
  plot.id = name + "-rate";
  plot.title = "What an error buys: queries a second";
  plot.description = fmt::format(
      "Queries a second of one thread against the 99 % quantile of the promised error, for {} "
      "points: {} settings. The table below has the figures.",
      name, plot.points.size());
  plot.y = PlotAxis::logarithmic("queries a second", values_of(plot), kMinRate, tick_count);
  plot.has_steps = true;
  return plot;
}

SvgPlot pages_plot(const TradeRecord& record, std::size_t workload) {
  SvgPlot plot = waiting_plot(record, workload, pages_per_query);
  const std::string name = name_of(record.workloads[workload]);
  plot.id = name + "-pages";
  plot.title = "What an error saves: pages read";
  plot.description = fmt::format(
      "Pages read a query, of a model of which none was in memory, against the 99 % quantile of "
      "the promised error, for {} points: {} settings. The table below has the figures.",
      name, plot.points.size());
  plot.y = PlotAxis::logarithmic("pages a query", values_of(plot), kMinPages, short_text);
  return plot;
}

SvgPlot width_plot(const TradeRecord& record) {
  SvgPlot plot = paced_plot(
      record, [&](const TradeResult& result, PlotPoint& point, std::vector<PlotPoint>& points) {
        point.y = record.share(result.promised.p99);
        point.stem = record.share(result.promised.p50);
        points.push_back(point);
        // The outline covers the end of the stem.
        point.y = *point.stem;
        point.stem.reset();
        point.is_hollow = true;
        points.push_back(point);
      });
  plot.id = "paced-width";
  plot.title = "Promised error without waiting";
  plot.description =
      "Median and 99 % quantile of the promised error of queries that do not wait for pages, "
      "within "
      "each memory budget, by workload. The table below has the figures.";
  plot.y = error_axis(record, "promised error, in diagonals", false);
  plot.hollow_note = "filled: p99, outline: median";
  return plot;
}

SvgPlot degraded_plot(const TradeRecord& record) {
  SvgPlot plot = paced_plot(
      record, [](const TradeResult& result, PlotPoint& point, std::vector<PlotPoint>& points) {
        point.y = static_cast<double>(result.degraded) / static_cast<double>(result.points);
        point.stem = 0;
        points.push_back(point);
      });
  plot.id = "paced-degraded";
  plot.title = "Degraded answers without waiting";
  plot.description =
      "Share of degraded answers of queries that do not wait for pages, within each memory budget, "
      "by workload. The table below has the figures.";
  plot.y = PlotAxis::percent("degraded answers");
  return plot;
}

}  // namespace planetree::tools
