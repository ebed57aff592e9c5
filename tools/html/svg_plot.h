#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/html/plot_axis.h"
#include "tools/html/plot_shape.h"

namespace planetree::tools {

/// Points of one kind. Its place in the list of series chooses its colour, of kPlotColours.
struct PlotSeries {
  std::string name;
  PlotShape shape = PlotShape::kCircle;
};
inline constexpr std::size_t kPlotColours = 6;

/// A point of a plot.
struct PlotPoint {
  double x = 0, y = 0;
  std::size_t series = 0;
  std::string key;             ///< names the figures to show for it, see HtmlPage::figures
  std::string label;           ///< written beside it if there is room; may be empty
  bool is_muted = false;       ///< shown in grey
  bool is_hollow = false;      ///< shown as an outline
  std::optional<double> stem;  ///< a line leads from the point to this y
  double shift = 0;            ///< moves it right, in units of the drawing
};

/// A plot of points. Its texts need no escape.
struct SvgPlot {
  std::string id;  ///< of letters, digits and "-", unique in the page
  std::string title;
  std::string description;  ///< what the plot shows, for those who do not see it
  PlotAxis x, y;
  std::optional<PlotAxis> upper_x;  ///< `x` in another unit
  std::vector<PlotSeries> series;
  std::vector<PlotPoint> points;
  bool has_steps = false;   ///< whether steps join the points that are not muted
  bool has_lines = false;   ///< whether lines join the points of each series, in their order
  std::string muted_note;   ///< what grey means; empty if nothing is grey
  std::string hollow_note;  ///< what outlines mean; empty if there are none
};

/// The plot as HTML: a figure with its title, a legend and a drawing that scales with the page.
[[nodiscard]] std::string plot_html(const SvgPlot& plot);

}  // namespace planetree::tools
