#pragma once

#include <vector>

#include "tools/html/heat_strip.h"
#include "tools/html/html_page.h"
#include "tools/html/svg_plot.h"
#include "tools/tune/tune_record.h"

/// The plots of a tune page. Keys of points name rows of its tables.
namespace planetree::tools {

/// Keys of a size of the curves, of a felt budget, and of a window of time, by their places.
std::string size_key(std::size_t size);
std::string felt_key(std::size_t budget);
std::string window_key(std::size_t window);

/// Misses by number of frames: a series for each policy, and the optimum.
SvgPlot curves_plot(const TuneRecord& record);
/// Degraded answers, widths and ticks to exact by memory.
SvgPlot degraded_felt_plot(const TuneRecord& record);
SvgPlot width_felt_plot(const TuneRecord& record);
SvgPlot ticks_felt_plot(const TuneRecord& record);
/// Pages looked up, and pages missed, in each window of time.
SvgPlot working_set_plot(const TuneRecord& record);
/// Pages by their place in the model and in time.
HeatStrip looked_up_strip(const TuneRecord& record);
HeatStrip resident_strip(const TuneRecord& record);

}  // namespace planetree::tools
