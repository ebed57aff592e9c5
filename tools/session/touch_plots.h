#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/html/column_plot.h"
#include "tools/html/svg_plot.h"
#include "tools/session/sorted.h"
#include "tools/session/touch_timeline.h"

/// The plots of a session's page. What they draw carries the keys below.
namespace planetree::tools {

/// Measured times of a session, by what took them.
struct TouchTimes {
  std::string name;
  Sorted<std::uint32_t> nanoseconds;
};

/// Quantiles that are shown of so many values, each as n: one in n values exceeds it.
std::vector<double> quantiles_shown(std::size_t values);
/// "99.9 %" for 1000.
std::string quantile_words(double n);
std::string quantile_key(std::size_t i);
std::string touch_window_key(std::size_t window);

/// Times in microseconds by quantile.
///
/// values  number of values, 1 or more
SvgPlot times_plot(const std::vector<TouchTimes>& times, std::size_t values);
/// Median and greatest latency of each window.
ColumnPlot latency_plot(const TouchTimeline& timeline);
/// Share of degraded ticks in each window.
ColumnPlot degraded_ticks_plot(const TouchTimeline& timeline);
/// Greatest width of the degraded answers of each window.
ColumnPlot tick_width_plot(const TouchTimeline& timeline);

}  // namespace planetree::tools
