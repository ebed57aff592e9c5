#pragma once

#include <string>
#include <vector>

#include "tools/html/svg_plot.h"

namespace planetree::tools {

/// A rectangle of the drawing, in its units; y goes down.
struct PlotRect {
  double left = 0, top = 0, right = 0, bottom = 0;

  bool overlaps(const PlotRect& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
  bool contains(const PlotRect& other) const {
    return left <= other.left && other.right <= right && top <= other.top && other.bottom <= bottom;
  }
};

/// A position in the drawing.
struct PlotPlace {
  double x = 0, y = 0;
};

/// A label beside a point.
struct PlotLabel {
  std::size_t point = 0;  ///< its place in SvgPlot::points
  double x = 0, y = 0;    ///< of the text's baseline
  const char* anchor = "start";
  bool is_for_wide_pages = false;  ///< it has no room in the larger text of narrow pages
};

/// Where the parts of a plot lie in its drawing.
struct PlotLayout {
  double width = 0, height = 0;
  PlotRect frame;                 ///< of the points
  std::vector<PlotPlace> points;  ///< as SvgPlot::points
  std::vector<PlotLabel> labels;

  double x_of(double place) const { return frame.left + place * (frame.right - frame.left); }
  double y_of(double place) const { return frame.bottom - place * (frame.bottom - frame.top); }
};

/// Lays a plot out. Points in the lane of an axis make way for each other. A label is left out if
/// it has no room.
[[nodiscard]] PlotLayout lay_out(const SvgPlot& plot);

}  // namespace planetree::tools
