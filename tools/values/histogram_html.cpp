#include "tools/values/histogram_html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/html/html_text.h"
#include "tools/html/plot_axis.h"

namespace planetree::tools {
namespace {

// In units of the drawing, with the text sizes of the page's style.
constexpr double kWidth = 480, kHeight = 280;
constexpr double kLeft = 58, kRight = 18, kTop = 34, kBottom = 66;
constexpr double kPlotWidth = kWidth - kLeft - kRight, kPlotHeight = kHeight - kTop - kBottom;
constexpr double kBandTop = kHeight - kBottom + 4, kBandHeight = 9;
constexpr int kBandCells = 64;

/// The ends of the axis, and where values lie on it.
struct Across {
  double lower, upper;

  double x_of(double value) const { return kLeft + kPlotWidth * (value - lower) / (upper - lower); }
  bool has(double value) const { return value >= lower && value <= upper; }
};

/// Multiples of 1, 2 or 5 times a power of ten, at most 7.
std::vector<double> ticks_of(const Across& across) {
  constexpr double kMaxTicks = 7;
  const double span = across.upper - across.lower;
  double step = std::pow(10.0, std::floor(std::log10(span / kMaxTicks)));
  for (const double factor : {2.0, 2.5, 2.0, 2.0}) {
    if (std::floor(span / step) + 1 <= kMaxTicks) break;
    step *= factor;
  }
  std::vector<double> ticks;
  const double slack = 1e-9 * step;
  for (double n = std::ceil((across.lower - slack) / step); n * step <= across.upper + slack; ++n)
    ticks.push_back(n * step);
  return ticks;
}

std::string percent_text(double share) { return short_text(100 * share) + " %"; }

void add_bars(const HistogramFigure& figure, const Across& across, const PlotAxis& y,
              std::string& html) {
  const ValueSketch::Histogram& histogram = figure.histogram;
  const std::size_t bins = histogram.shares.size();
  const double width = (histogram.upper - histogram.lower) / static_cast<double>(bins);
  for (std::size_t i = 0; i < bins; ++i) {
    if (!(histogram.shares[i] > 0)) continue;
    const double from = histogram.lower + width * static_cast<double>(i);
    const double height = std::max(kPlotHeight * y.place(histogram.shares[i]), 0.5);
    fmt::format_to(std::back_inserter(html),
                   "<rect class=\"cell\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" "
                   "height=\"{:.2f}\"><title>{} to {}: {}</title></rect>\n",
                   across.x_of(from) + 0.3, kHeight - kBottom - height,
                   std::max(kPlotWidth / static_cast<double>(bins) - 0.6, 0.4), height,
                   number_text(from), number_text(from + width),
                   html_text(fmt::format("{:.3g} %", 100 * histogram.shares[i])));
  }
}

void add_colours(const Across& across, const ColourScale& colours, std::string& html) {
  const double width = kPlotWidth / kBandCells;
  for (int i = 0; i < kBandCells; ++i) {
    const double value = across.lower + (across.upper - across.lower) * (i + 0.5) / kBandCells;
    fmt::format_to(std::back_inserter(html),
                   "<rect x=\"{:.2f}\" y=\"{:g}\" width=\"{:.2f}\" height=\"{:g}\" "
                   "fill=\"{}\"/>\n",
                   kLeft + width * i, kBandTop, i + 1 < kBandCells ? width + 1 : width, kBandHeight,
                   css_colour(colours.colour(value)));
  }
  fmt::format_to(std::back_inserter(html),
                 "<rect class=\"frame\" x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\"/>\n",
                 kLeft, kBandTop, kPlotWidth, kBandHeight);
}

void add_axes(const HistogramFigure& figure, const Across& across, const PlotAxis& y,
              std::string& html) {
  for (const PlotTick& tick : y.ticks()) {
    const double at = kHeight - kBottom - kPlotHeight * tick.place;
    fmt::format_to(std::back_inserter(html),
                   "<path class=\"grid\" d=\"M{:g} {:.1f}H{:g}\"/>\n"
                   "<text class=\"tick\" x=\"{:g}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
                   kLeft, at, kWidth - kRight, kLeft - 6, at + 4, html_text(tick.text));
  }
  const std::vector<double> ticks = ticks_of(across);
  const auto zero = static_cast<std::size_t>(
      std::ranges::find_if(ticks, [](double tick) { return tick == 0; }) - ticks.begin());
  for (std::size_t i = 0; i < ticks.size(); ++i)
    fmt::format_to(std::back_inserter(html),
                   "<text class=\"tick{}\" x=\"{:.1f}\" y=\"{:g}\" text-anchor=\"middle\">{}"
                   "</text>\n",
                   ticks.size() > 4 && (i + zero) % 2 == 1 ? " extra" : "",
                   std::clamp(across.x_of(ticks[i]), kLeft + 6, kWidth - kRight - 12),
                   kBandTop + kBandHeight + 17, html_text(short_text(ticks[i])));
  fmt::format_to(std::back_inserter(html),
                 "<text class=\"title\" x=\"{:.1f}\" y=\"{:g}\" text-anchor=\"middle\">{}</text>\n"
                 "<text class=\"title\" x=\"4\" y=\"14\">{}</text>\n",
                 kLeft + kPlotWidth / 2, kHeight - 8, html_text(figure.x_title),
                 html_text(figure.y_title));
}

void add_marks(const HistogramFigure& figure, const Across& across, std::string& html) {
  for (const HistogramMark& mark : figure.marks) {
    if (!across.has(mark.value)) continue;
    fmt::format_to(std::back_inserter(html),
                   "<path class=\"mark\" stroke-dasharray=\"4 3\" d=\"M{0:.1f} {1:g}V{2:g}\">"
                   "<title>{3}</title></path>\n",
                   across.x_of(mark.value), kTop, kHeight - kBottom, html_text(mark.text));
  }
}

/// What the histogram leaves out, and what dashes mean.
std::string legend_of(const HistogramFigure& figure, const Across& across) {
  std::string items;
  const auto add = [&](const std::string& text) {
    items += fmt::format("<li>{}</li>", html_text(text));
  };
  for (const HistogramMark& mark : figure.marks)
    if (across.has(mark.value)) {
      add("dashes: " + mark.text);
      break;
    }
  if (figure.histogram.below > 0)
    add(fmt::format("{:.3g} % below {}", 100 * figure.histogram.below, number_text(across.lower)));
  if (figure.histogram.above > 0)
    add(fmt::format("{:.3g} % above {}", 100 * figure.histogram.above, number_text(across.upper)));
  return items.empty() ? items : "<ul class=\"legend\">" + items + "</ul>\n";
}

}  // namespace

std::string histogram_html(const HistogramFigure& figure, const ColourScale& colours) {
  const ValueSketch::Histogram& histogram = figure.histogram;
  const Across across{histogram.lower, histogram.upper};
  double most = 0;
  for (const double share : histogram.shares) most = std::max(most, share);
  const PlotAxis y = PlotAxis::linear(figure.y_title, most, percent_text);
  std::string html = fmt::format(
      "<figure>\n<figcaption>{1}</figcaption>\n{2}"
      "<svg class=\"plot\" id=\"{0}\" viewBox=\"0 0 {3:g} {4:g}\" role=\"img\" "
      "aria-labelledby=\"{0}-title {0}-desc\"><title id=\"{0}-title\">{1}</title>"
      "<desc id=\"{0}-desc\">{5}</desc>\n",
      figure.id, html_text(figure.title), legend_of(figure, across), kWidth, kHeight,
      html_text(figure.description));
  add_axes(figure, across, y, html);
  add_bars(figure, across, y, html);
  add_marks(figure, across, html);
  add_colours(across, colours, html);
  return html + "</svg>\n</figure>\n";
}

}  // namespace planetree::tools
