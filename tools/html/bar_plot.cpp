#include "tools/html/bar_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "tools/html/html_text.h"
#include "tools/html/plot_figure.h"

namespace planetree::tools {
namespace {

// In units of the drawing, with the text sizes of the page's style.
constexpr double kBarPlotWidth = 480, kNamesWidth = 132, kLabelsWidth = 86;
constexpr double kRowHeight = 24, kBarHeight = 15, kAbove = 8, kBelow = 46;

double x_at(double place) {
  return kNamesWidth + place * (kBarPlotWidth - kNamesWidth - kLabelsWidth);
}

}  // namespace

std::string bar_plot_html(const BarPlot& plot) {
  const double bottom = kAbove + kRowHeight * static_cast<double>(plot.bars.size());
  std::string svg =
      svg_begin({plot.id, plot.title, plot.description, kBarPlotWidth, bottom + kBelow});
  const auto out = std::back_inserter(svg);
  for (std::size_t i = 0; i < plot.x.ticks().size(); ++i) {
    const PlotTick& tick = plot.x.ticks()[i];
    fmt::format_to(out,
                   R"(<path class="grid" d="M{0:.1f} {1:g}V{2:g}"/>)"
                   R"(<text class="{3}" x="{0:.1f}" y="{4:g}" text-anchor="middle">{5}</text>)"
                   "\n",
                   x_at(tick.place), kAbove, bottom, tick_class(plot.x, i), bottom + 16,
                   html_text(tick.text));
  }
  fmt::format_to(out,
                 R"(<text class="title" x="{:.1f}" y="{:g}" text-anchor="middle">{}</text>)"
                 "\n",
                 x_at(0.5), bottom + kBelow - 8, html_text(plot.x.title()));
  double top = kAbove;
  for (const PlotBar& bar : plot.bars) {
    const double width = std::max(x_at(plot.x.place(bar.value)) - kNamesWidth, 0.5);
    const double text = top + kRowHeight / 2 + 4;
    fmt::format_to(out,
                   R"(<text class="tick" x="{:g}" y="{:g}" text-anchor="end">{}</text>)"
                   R"(<g class="point c0" data-key="{}"><rect class="shape column" x="{:g}" )"
                   R"(y="{:g}" width="{:.2f}" height="{:g}"/>)"
                   R"(<rect class="hit" x="0" y="{:g}" width="{:g}" height="{:g}"/></g>)"
                   R"(<text class="label" x="{:.2f}" y="{:g}">{}</text>)"
                   "\n",
                   kNamesWidth - 7, text, html_text(bar.name), html_text(bar.key), kNamesWidth,
                   top + (kRowHeight - kBarHeight) / 2, width, kBarHeight, top, kBarPlotWidth,
                   kRowHeight, kNamesWidth + width + 6, text, html_text(bar.label));
    top += kRowHeight;
  }
  fmt::format_to(out, R"(<path class="frame" d="M{:g} {:g}V{:g}"/></svg>)", kNamesWidth, kAbove,
                 bottom);
  return figure_html(plot.title, {}, svg + "\n");
}

}  // namespace planetree::tools
