#include "tools/tune/tune_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tools/cli/policy_option.h"
#include "tools/cli/size_text.h"
#include "tools/html/html_text.h"

namespace planetree::tools {
namespace {

constexpr double kMinRatio = 1e-7, kMinShare = 1e-6, kMinWidth = 1e-9;
constexpr double kMiB = 1 << 20;
constexpr std::size_t kStripRows = 40;

constexpr std::array<PlotShape, 6> kShapes = {PlotShape::kCircle,  PlotShape::kSquare,
                                              PlotShape::kDiamond, PlotShape::kTriangle,
                                              PlotShape::kPlus,    PlotShape::kDownTriangle};

std::string count_text(double value) { return grouped_count(static_cast<std::uint64_t>(value)); }

/// A plot of a value of the felt budgets.
template <class Value>
SvgPlot felt_plot(const TuneRecord& record, const char* name, const char* title,
                  const Value& value) {
  SvgPlot plot;
  plot.id = fmt::format("felt-{}", name);
  plot.title = title;
  plot.series = {{"recorded motion, replayed", PlotShape::kCircle}};
  std::vector<double> memory;
  for (std::size_t i = 0; i < record.felt.size(); ++i) {
    PlotPoint point;
    point.x = static_cast<double>(record.felt[i].memory_bytes) / kMiB;
    point.y = value(record.felt[i].figures);
    point.key = felt_key(i);
    if (record.recommended && record.recommended->is_kept &&
        record.felt[i].memory_bytes == record.recommended->memory_bytes)
      point.label = "recommended";
    memory.push_back(point.x);
    plot.points.push_back(std::move(point));
  }
  plot.x = PlotAxis::logarithmic("memory budget, MiB", memory, 1e-3, short_text);
  plot.has_lines = true;
  plot.description =
      fmt::format("{} against the memory budget. The table below has the figures.", title);
  return plot;
}

std::vector<double> values_of(const SvgPlot& plot) {
  std::vector<double> values;
  for (const PlotPoint& point : plot.points) values.push_back(point.y);
  return values;
}

double seconds_of(const TuneRecord& record, std::size_t windows) {
  return 1e-9 * static_cast<double>(windows * record.timeline.window_ns());
}

HeatStrip strip_of(const TuneRecord& record, PageSet TraceTimeline::Window::*set) {
  HeatStrip strip;
  const TraceTimeline& timeline = record.timeline;
  strip.columns = timeline.windows().size();
  strip.rows = timeline.rows(kStripRows);
  strip.values = timeline.shares(set, kStripRows);
  strip.x_end = seconds_of(record, strip.columns);
  strip.x = PlotAxis::linear("seconds", strip.x_end, short_text);
  for (std::size_t i = 0; i < strip.columns; ++i) strip.keys.push_back(window_key(i));
  strip.y_title = "pages: tree, caps and mask, each by octcode";
  return strip;
}

}  // namespace

std::string size_key(std::size_t size) { return fmt::format("size-{}", size); }
std::string felt_key(std::size_t budget) { return fmt::format("felt-{}", budget); }
std::string window_key(std::size_t window) { return fmt::format("window-{}", window); }

SvgPlot curves_plot(const TuneRecord& record) {
  SvgPlot plot;
  plot.id = "misses";
  plot.title = "Misses by number of frames";
  const MissCurves& curves = record.curves;
  std::vector<double> frames;
  const auto add = [&](const std::string& name, const std::vector<double>& misses) {
    const std::size_t series = plot.series.size();
    plot.series.push_back({name, kShapes[series % kShapes.size()]});
    for (std::size_t i = 0; i < misses.size(); ++i) {
      PlotPoint point;
      point.x = curves.frames[i];
      point.y = record.ratio(misses[i]);
      point.series = series;
      point.key = size_key(i);
      frames.push_back(point.x);
      plot.points.push_back(std::move(point));
    }
  };
  for (const MissCurve& curve : curves.policies) add(name_of(curve.policy), curve.misses);
  add("optimum", curves.optimum);
  plot.x = PlotAxis::logarithmic("frames", frames, 1, count_text);
  plot.y = PlotAxis::logarithmic("misses a lookup", values_of(plot), kMinRatio, short_power_text);
  plot.has_lines = true;
  plot.description = fmt::format(
      "Misses a lookup of {} policies and of Belady's optimum against the number of frames, {} "
      "sizes. The table below has the figures.",
      curves.policies.size(), curves.frames.size());
  return plot;
}

SvgPlot degraded_felt_plot(const TuneRecord& record) {
  SvgPlot plot = felt_plot(record, "degraded", "Degraded answers", [](const FeltFigures& figures) {
    return static_cast<double>(figures.degraded) /
           static_cast<double>(std::max<std::size_t>(figures.ticks, 1));
  });
  plot.y = PlotAxis::logarithmic("share of answers", values_of(plot), kMinShare, short_power_text);
  return plot;
}

SvgPlot width_felt_plot(const TuneRecord& record) {
  SvgPlot plot = felt_plot(record, "width", "Width of answers, 99 % quantile",
                           [](const FeltFigures& figures) { return figures.width_p99; });
  plot.y = PlotAxis::logarithmic("model units", values_of(plot), kMinWidth, short_power_text);
  return plot;
}

SvgPlot ticks_felt_plot(const TuneRecord& record) {
  SvgPlot plot = felt_plot(
      record, "ticks", "Degraded answers in a row, 99 % quantile",
      [](const FeltFigures& figures) { return static_cast<double>(figures.ticks_to_exact_p99); });
  const std::vector<double> values = values_of(plot);
  plot.y = PlotAxis::linear("answers", *std::max_element(values.begin(), values.end()), short_text);
  return plot;
}

SvgPlot working_set_plot(const TuneRecord& record) {
  SvgPlot plot;
  plot.id = "working-set";
  const auto& windows = record.timeline.windows();
  plot.title = fmt::format("Pages looked up in each {} s", number_text(seconds_of(record, 1)));
  plot.description = plot.title + ", and lookups that missed. The table below has the figures.";
  plot.series = {{"pages looked up", PlotShape::kCircle}, {"misses", PlotShape::kSquare}};
  double most = 0;
  for (std::size_t series = 0; series < 2; ++series)
    for (std::size_t i = 0; i < windows.size(); ++i) {
      PlotPoint point;
      point.x = seconds_of(record, i) + seconds_of(record, 1) / 2;
      point.y = static_cast<double>(series == 0 ? windows[i].looked_up.size() : windows[i].misses);
      point.series = series;
      point.key = window_key(i);
      most = std::max(most, point.y);
      plot.points.push_back(std::move(point));
    }
  plot.x = PlotAxis::linear("seconds", seconds_of(record, windows.size()), short_text);
  plot.y = PlotAxis::linear("pages", most, short_text);
  plot.has_lines = true;
  return plot;
}

HeatStrip looked_up_strip(const TuneRecord& record) {
  HeatStrip strip = strip_of(record, &TraceTimeline::Window::looked_up);
  strip.id = "looked-up";
  strip.title = "Pages looked up, by place and time";
  strip.description =
      "Share of the pages of each row that queries looked up in each window of time. Neighbouring "
      "rows are neighbours in the model.";
  strip.legend = "stronger: more of the pages of a row";
  return strip;
}

HeatStrip resident_strip(const TuneRecord& record) {
  HeatStrip strip = strip_of(record, &TraceTimeline::Window::resident);
  strip.id = "resident";
  strip.title = "Pages in memory, by place and time";
  strip.description =
      "Share of the pages of each row that were in memory in each window of time, as recorded.";
  strip.legend = "stronger: more of the pages of a row";
  return strip;
}

}  // namespace planetree::tools
