#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/html/plot_axis.h"

namespace planetree::tools {

/// A drawing of cells in columns and rows, the stronger the greater their values. Its texts need no
/// escape.
struct HeatStrip {
  std::string id;  ///< of letters, digits and "-", unique in the page
  std::string title;
  std::string description;  ///< what the drawing shows, for those who do not see it
  PlotAxis x;               ///< below the columns
  double x_end = 1;         ///< value of the end of the last column; the first begins at 0
  std::string y_title;      ///< what the rows are
  std::size_t columns = 0, rows = 0;
  std::vector<float> values;  ///< 0 to 1, row by row, the lowest row first
  std::string legend;         ///< what 0 and 1 mean
  /// By column: names the figures to show for it, see HtmlPage::figures. Empty: there are none.
  std::vector<std::string> keys;
};

/// The strip as HTML: a figure with its title, its legend and a drawing that scales with the page.
[[nodiscard]] std::string strip_html(const HeatStrip& strip);

}  // namespace planetree::tools
