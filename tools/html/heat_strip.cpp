#include "tools/html/heat_strip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

#include "tools/html/html_text.h"

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

}  // namespace

std::string strip_html(const HeatStrip& strip) {
  assert(strip.values.size() == strip.columns * strip.rows);
  std::string text = fmt::format(
      "<figure>\n<figcaption>{1}</figcaption>\n<ul class=\"legend\"><li>{2}</li></ul>\n"
      "<svg class=\"plot\" id=\"{0}\" viewBox=\"0 0 {3:g} {4:g}\" role=\"img\" "
      "aria-labelledby=\"{0}-title {0}-desc\"><title id=\"{0}-title\">{1}</title>"
      "<desc id=\"{0}-desc\">{5}</desc>\n"
      "<rect class=\"lane\" x=\"{6:g}\" y=\"{7:g}\" width=\"{8:g}\" height=\"{9:g}\"/>\n",
      strip.id, html_text(strip.title), html_text(strip.legend), kWidth, kHeight,
      html_text(strip.description), kLeft, kTop, kWidth - kLeft - kRight, kHeight - kTop - kBottom);
  for (int shade = 1; shade <= kShades; ++shade) add_shade(strip, shade, text);
  const std::size_t ticks = strip.x.ticks().size();
  for (std::size_t i = 0; i < ticks; ++i)
    text += fmt::format(
        "<text class=\"tick{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
        ticks > 5 && i % 2 == 1 ? " extra" : "",
        kLeft + (kWidth - kLeft - kRight) * strip.x.ticks()[i].place, kHeight - kBottom + 16,
        html_text(strip.x.ticks()[i].text));
  text += fmt::format(
      "<text class=\"title\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n"
      "<text class=\"title\" x=\"4\" y=\"14\">{}</text>\n</svg>\n</figure>\n",
      kWidth / 2, kHeight - 8, html_text(strip.x.title()), html_text(strip.y_title));
  return text;
}

}  // namespace planetree::tools
