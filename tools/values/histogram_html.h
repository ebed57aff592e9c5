#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/html/column_plot.h"
#include "tools/html/html_page.h"
#include "tools/values/colour_scale.h"
#include "tools/values/value_sketch.h"

namespace planetree::tools {

/// A histogram with the colours of its values below. Its texts need no escape.
struct HistogramFigure {
  std::string id;  ///< of letters, digits and "-", unique in the page
  std::string title;
  std::string description;  ///< what it shows, for those who do not see it
  std::string x_title, y_title;
  ValueSketch::Histogram histogram;
  std::vector<ColumnMark> marks;  ///< such as a tolerance
};

/// The histogram as HTML: a figure that scales with the page, and a table of its columns.
///
/// figures  of the page; those of the columns are added
[[nodiscard]] std::string histogram_html(const HistogramFigure& figure, const ColourScale& colours,
                                         std::map<std::string, HtmlFigures>& figures);

}  // namespace planetree::tools
