#pragma once

#include <string>
#include <vector>

#include "tools/html/plot_axis.h"

namespace planetree::tools {

/// A bar with its name.
struct PlotBar {
  std::string name;
  double value = 0;
  std::string label;  ///< written behind the bar
  std::string key;    ///< names the figures to show for it, see HtmlPage::figures
};

/// A plot of bars below each other, for parts that have names. Its texts need no escape.
struct BarPlot {
  std::string id;  ///< of letters, digits and "-", unique in the page
  std::string title;
  std::string description;  ///< what the plot shows, for those who do not see it
  PlotAxis x;               ///< of the values
  std::vector<PlotBar> bars;
};

/// The plot as HTML: a figure with its title and a drawing that scales with the page.
[[nodiscard]] std::string bar_plot_html(const BarPlot& plot);

}  // namespace planetree::tools
