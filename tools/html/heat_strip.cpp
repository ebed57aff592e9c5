#include "tools/html/heat_strip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

#include "tools/html/html_text.h"
#include "tools/html/plot_figure.h"

namespace planetree::tools {
namespace {

// As large as a plot, with the text sizes of the page's style.
constexpr double kWidth = 480, kHeight = 250;
constexpr double kLeft = 18, kRight = 18, kTop = 28, kBottom = 46;
constexpr int kShades = 6;

/// Appends the cells of one shade as one path: neighbours of a row are one rectangle.
void add_shade(const HeatStrip& strip, int shade, std::string& text) {
  const double width =
      (kWidth - kLeft - kRight) * strip.x.place(strip.x_end) / static_cast<double>(strip.columns);
  const double height = (kHeight - kTop - kBottom) / static_cast<double>(strip.rows);
  const auto shade_of = [&](std::size_t row, std::size_t column) {
    const float value = std::clamp(strip.values[row * strip.columns + column], 0.0F, 1.0F);
    return static_cast<int>(std::ceil(value * kShades));
  };
  std::string path;
  for (std::size_t row = 0; row < strip.rows; ++row)
    for (std::size_t column = 0; column < strip.columns;) {
      std::size_t end = column;
      while (end < strip.columns && shade_of(row, end) == shade) ++end;
      if (end > column)
        fmt::format_to(std::back_inserter(path), "M{:.1f} {:.1f}h{:.1f}v{:.1f}h{:.1f}Z",
                       kLeft + width * static_cast<double>(column),
                       kHeight - kBottom - height * static_cast<double>(row + 1),
                       width * static_cast<double>(end - column), height,
                       -width * static_cast<double>(end - column));
      column = std::max(end, column + 1);
    }
  if (!path.empty())
    text += fmt::format("<path class=\"cell\" fill-opacity=\"{:.2f}\" d=\"{}\"/>\n",
                        static_cast<double>(shade) / kShades, path);
}

/// The area of each column where a pointer is on it.
std::string column_areas(const HeatStrip& strip) {
  const double width =
      (kWidth - kLeft - kRight) * strip.x.place(strip.x_end) / static_cast<double>(strip.columns);
  std::string text;
  for (std::size_t i = 0; i < strip.keys.size(); ++i)
    text += fmt::format(
        "<g class=\"point\" data-key=\"{}\"><rect class=\"shape hit column\" x=\"{:.1f}\" "
        "y=\"{:g}\" width=\"{:.1f}\" height=\"{:g}\"/></g>\n",
        html_text(strip.keys[i]), kLeft + width * static_cast<double>(i), kTop, width,
        kHeight - kTop - kBottom);
  return text;
}

}  // namespace

std::string strip_html(const HeatStrip& strip) {
  assert(strip.values.size() == strip.columns * strip.rows);
  assert(strip.keys.empty() || strip.keys.size() == strip.columns);
  std::string text = svg_begin({strip.id, strip.title, strip.description, kWidth, kHeight});
  text +=
      fmt::format("<rect class=\"lane\" x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\"/>\n",
                  kLeft, kTop, kWidth - kLeft - kRight, kHeight - kTop - kBottom);
  for (int shade = 1; shade <= kShades; ++shade) add_shade(strip, shade, text);
  text += column_areas(strip);
  for (std::size_t i = 0; i < strip.x.ticks().size(); ++i)
    text += fmt::format(
        "<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
        tick_class(strip.x, i), kLeft + (kWidth - kLeft - kRight) * strip.x.ticks()[i].place,
        kHeight - kBottom + 16, html_text(strip.x.ticks()[i].text));
  text += fmt::format(
      "<text class=\"title\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n"
      "<text class=\"title\" x=\"4\" y=\"14\">{}</text>\n</svg>\n",
      kWidth / 2, kHeight - 8, html_text(strip.x.title()), html_text(strip.y_title));
  return figure_html(strip.title, legend_item(strip.legend), text);
}

}  // namespace planetree::tools
