#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/html/plot_axis.h"
#include "tools/html/svg_plot.h"

namespace planetree::tools {

/// A column over a range of the axis, such as the values of a bin.
struct PlotColumn {
  double from = 0, to = 0;       ///< on the x axis
  double y = 0;                  ///< its upper end; no column is drawn for 0
  std::optional<double> bottom;  ///< its lower end; that of the axis if empty
  std::size_t series = 0;        ///< the shape of series other than 0 is above the column
  std::string key;               ///< names the figures to show for it, see HtmlPage::figures
};

/// A dashed line from top to bottom.
struct ColumnMark {
  double x = 0;  ///< none is drawn outside of the axis
  std::string text;
};

/// A plot of columns, such as a histogram. Its texts need no escape.
struct ColumnPlot {
  std::string id;  ///< of letters, digits and "-", unique in the page
  std::string title;
  std::string description;  ///< what the plot shows, for those who do not see it
  PlotAxis x, y;
  std::vector<PlotSeries> series;  ///< as in SvgPlot; a single one has no legend
  std::vector<PlotColumn> columns;
  std::vector<ColumnMark> marks;
  std::vector<std::string> notes;  ///< further items of the legend
  std::vector<std::string> band;   ///< CSS colours below the axis, from left to right; may be empty
};

/// The plot as HTML: a figure with its title, a legend and a drawing that scales with the page.
[[nodiscard]] std::string column_plot_html(const ColumnPlot& plot);

}  // namespace planetree::tools
