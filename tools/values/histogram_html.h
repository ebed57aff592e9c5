#pragma once

#include <string>
#include <vector>

#include "tools/values/colour_scale.h"
#include "tools/values/value_sketch.h"

namespace planetree::tools {

/// A value to mark in a histogram, such as a tolerance.
struct HistogramMark {
  double value = 0;
  std::string text;
};

/// A histogram with the colours of its values below. Its texts need no escape.
struct HistogramFigure {
  std::string id;  ///< of letters, digits and "-", unique in the page
  std::string title;
  std::string description;  ///< what it shows, for those who do not see it
  std::string x_title, y_title;
  ValueSketch::Histogram histogram;
  std::vector<HistogramMark> marks;  ///< those outside of the histogram are left out
};

/// The histogram as HTML: a figure that scales with the page.
[[nodiscard]] std::string histogram_html(const HistogramFigure& figure, const ColourScale& colours);

}  // namespace planetree::tools
