#include "tools/session/touch_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/html/html_text.h"

namespace planetree::tools {
namespace {

// Below any time and any width that is measured.
constexpr double kMinPositive = 1e-300;

double share_of(double n) { return 1 - 1 / n; }

/// A plot with a column for each window of time.
ColumnPlot over_time(const TouchTimeline& timeline, const char* id, const char* title,
                     const char* description) {
  const TouchTimeline::Window& last = timeline.windows().back();
  ColumnPlot plot{
      id,
      title,
      description,
      PlotAxis::between("seconds", 0, timeline.seconds(last.first + last.ticks), short_text),
      PlotAxis::percent(""),
      {},
      {},
      {},
      {},
      {}};
  for (std::size_t i = 0; i < timeline.windows().size(); ++i) {
    const TouchTimeline::Window& window = timeline.windows()[i];
    PlotColumn column;
    column.from = timeline.seconds(window.first);
    column.to = timeline.seconds(window.first + window.ticks);
    column.key = touch_window_key(i);
    plot.columns.push_back(std::move(column));
  }
  return plot;
}

}  // namespace

std::vector<double> quantiles_shown(std::size_t values) {
  const auto most = static_cast<double>(values);
  std::vector<double> shown = {1};
  for (double nines = 1; nines <= most; nines *= 10)
    for (const double n : {2 * nines, 4 * nines, 10 * nines})
      if (n < most) shown.push_back(n);
  if (most > 1) shown.push_back(most);
  return shown;
}

std::string quantile_words(double n) {
  if (n <= 1) return "min";
  return fmt::format("{:.9g} %", 100 - 100 / n);
}

std::string quantile_key(std::size_t i) { return fmt::format("quantile-{}", i); }
std::string touch_window_key(std::size_t window) { return fmt::format("window-{}", window); }

SvgPlot times_plot(const std::vector<TouchTimes>& times, std::size_t values) {
  constexpr PlotShape kShapes[] = {PlotShape::kCircle, PlotShape::kSquare, PlotShape::kTriangle};
  SvgPlot plot;
  plot.id = "times";
  plot.title = "Times by quantile";
  plot.description =
      "Latency of the ticks, time of the query alone, and lateness of an idle thread, by quantile. "
      "The table below has the figures.";
  plot.x = PlotAxis::quantiles("quantile", static_cast<double>(values));
  std::vector<double> all;
  const std::vector<double> shown = quantiles_shown(values);
  for (std::size_t series = 0; series < times.size(); ++series) {
    plot.series.push_back({times[series].name, kShapes[series % std::size(kShapes)]});
    for (std::size_t i = 0; i < shown.size(); ++i) {
      PlotPoint point;
      point.x = shown[i];
      // The clock's unit is a nanosecond.
      point.y = std::max(times[series].nanoseconds.at(share_of(shown[i])), 1U) / 1e3;
      point.series = series;
      point.key = quantile_key(i);
      all.push_back(point.y);
      plot.points.push_back(std::move(point));
    }
  }
  plot.y = PlotAxis::logarithmic("microseconds", all, kMinPositive, short_text);
  plot.has_lines = true;
  return plot;
}

ColumnPlot latency_plot(const TouchTimeline& timeline) {
  ColumnPlot plot = over_time(timeline, "latency-time", "Latency over time",
                              "Columns from the median to the greatest latency of the ticks of "
                              "each window of time. The table below has the figures.");
  plot.series = {{"from median to greatest", PlotShape::kSquare},
                 {"with late ticks", PlotShape::kTriangle}};
  std::vector<double> all;
  for (std::size_t i = 0; i < plot.columns.size(); ++i) {
    const TouchTimeline::Window& window = timeline.windows()[i];
    PlotColumn& column = plot.columns[i];
    column.y = std::max(window.max_latency_us, 1e-3);
    column.bottom = std::max(window.median_latency_us, 1e-3);
    column.series = window.late > 0 ? 1 : 0;
    all.push_back(column.y);
    all.push_back(*column.bottom);
  }
  plot.y = PlotAxis::logarithmic("microseconds", all, kMinPositive, short_text);
  return plot;
}

ColumnPlot degraded_ticks_plot(const TouchTimeline& timeline) {
  ColumnPlot plot = over_time(timeline, "degraded-time", "Degraded ticks over time",
                              "Share of the ticks of each window of time whose answers are "
                              "degraded. The table below has the figures.");
  plot.series = {{"degraded", PlotShape::kSquare}};
  double most = 0;
  for (std::size_t i = 0; i < plot.columns.size(); ++i) {
    const TouchTimeline::Window& window = timeline.windows()[i];
    plot.columns[i].y = static_cast<double>(window.degraded) / static_cast<double>(window.ticks);
    most = std::max(most, plot.columns[i].y);
  }
  plot.y = PlotAxis::linear("degraded ticks", most,
                            [](double share) { return short_text(100 * share) + " %"; });
  return plot;
}

ColumnPlot tick_width_plot(const TouchTimeline& timeline) {
  ColumnPlot plot = over_time(timeline, "width-time", "Width of degraded answers over time",
                              "Greatest width of the degraded answers of each window of time. The "
                              "table below has the figures.");
  plot.series = {{"greatest width", PlotShape::kSquare}};
  std::vector<double> finite;
  for (const TouchTimeline::Window& window : timeline.windows())
    if (window.max_width > 0 && std::isfinite(window.max_width)) finite.push_back(window.max_width);
  if (finite.empty()) finite.push_back(1);
  const double most = *std::ranges::max_element(finite);
  for (std::size_t i = 0; i < plot.columns.size(); ++i) {
    const double width = timeline.windows()[i].max_width;
    plot.columns[i].y = std::min(width, most);
    if (width <= most) continue;
    plot.columns[i].series = 1;
    if (plot.series.size() == 1) plot.series.push_back({"without a bound", PlotShape::kTriangle});
  }
  // What is far below is rounding.
  constexpr double kMinShare = 1e-9;
  plot.y = PlotAxis::logarithmic("model units", finite, kMinShare * most, short_power_text);
  return plot;
}

}  // namespace planetree::tools
