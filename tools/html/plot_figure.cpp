#include "tools/html/plot_figure.h"

#include <fmt/format.h>

#include "tools/html/html_text.h"

namespace planetree::tools {

std::string svg_begin(const PlotFrame& frame) {
  return fmt::format(
      R"(<svg class="plot" id="{0}" viewBox="0 0 {1:g} {2:g}" role="img" tabindex="0" )"
      R"(aria-labelledby="{0}-title {0}-desc"><title id="{0}-title">{3}</title>)"
      R"(<desc id="{0}-desc">{4}</desc>)"
      "\n",
      frame.id, frame.width, frame.height, html_text(frame.title), html_text(frame.description));
}

std::string legend_item(const std::string& classes, PlotShape shape, const std::string& name) {
  return fmt::format(
      R"(<li><svg class="key" viewBox="-8 -8 16 16" aria-hidden="true"><g class="point {}">)"
      R"(<path class="shape" d="{}"/></g></svg>{}</li>)",
      classes, path_of(shape), html_text(name));
}

std::string legend_item(const std::string& name) { return "<li>" + html_text(name) + "</li>"; }

std::string figure_html(const std::string& title, const std::string& legend_items,
                        const std::string& svg) {
  return fmt::format("<figure>\n<figcaption>{}</figcaption>\n", html_text(title)) +
         (legend_items.empty() ? "" : R"(<ul class="legend">)" + legend_items + "</ul>\n") +
         R"(<div class="canvas">)" + svg +
         R"(<div class="tip" role="status"></div></div>)"
         "\n</figure>\n";
}

const char* tick_class(const PlotAxis& axis, std::size_t i) {
  constexpr std::size_t kMaxNarrowTicks = 5;
  constexpr double kMinNarrowGap = 0.1;  // of the axis: less than the width of a text
  const auto& ticks = axis.ticks();
  const bool is_close = i > 0 && ticks[i].place - ticks[i - 1].place < kMinNarrowGap;
  const bool is_extra = i % 2 == 1 && (is_close || ticks.size() > kMaxNarrowTicks);
  return is_extra ? "tick extra" : "tick";
}

}  // namespace planetree::tools
