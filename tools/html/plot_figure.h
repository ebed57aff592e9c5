#pragma once

#include <string>
#include <vector>

#include "tools/html/plot_axis.h"
#include "tools/html/plot_shape.h"

/// What the drawings of a page have in common.
namespace planetree::tools {

/// Names of a drawing and its size, in units of the drawing. Its texts need no escape.
struct PlotFrame {
  std::string id;  ///< of letters, digits and "-", unique in the page
  std::string title;
  std::string description;  ///< what the drawing shows, for those who do not see it
  double width = 0, height = 0;
};

/// Opens the drawing, an element that has the focus of the keyboard; `</svg>` closes it.
[[nodiscard]] std::string svg_begin(const PlotFrame& frame);

/// An item of a legend: a shape of a class of the page's style, and its name.
[[nodiscard]] std::string legend_item(const std::string& classes, PlotShape shape,
                                      const std::string& name);
/// An item of a legend without a shape.
[[nodiscard]] std::string legend_item(const std::string& name);

/// The figure: its title, its legend (items, may be empty), its drawing and the box for the figures
/// of a point.
[[nodiscard]] std::string figure_html(const std::string& title, const std::string& legend_items,
                                      const std::string& svg);

/// The class of the text of tick `i`. Where there are more ticks than the larger text of narrow
/// pages has room for, every other loses its text there; so does one that is close to the one
/// before it.
[[nodiscard]] const char* tick_class(const PlotAxis& axis, std::size_t i);

}  // namespace planetree::tools
