#include "tools/values/histogram_html.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/html/html_table.h"
#include "tools/html/html_text.h"

namespace planetree::tools {
namespace {

constexpr int kBandCells = 64;

std::string tick_percent(double share) { return short_text(100 * share) + " %"; }
std::string share_text(double share) { return number_text(100 * share) + " %"; }

/// One of the bins, and what lies outside of them.
struct Bin {
  std::string from, to, key;
  double lower = 0, upper = 0, share = 0;
};

/// Bins that are not empty.
std::vector<Bin> bins_of(const HistogramFigure& figure) {
  const ValueSketch::Histogram& histogram = figure.histogram;
  const double width =
      (histogram.upper - histogram.lower) / static_cast<double>(histogram.shares.size());
  std::vector<Bin> bins;
  for (std::size_t i = 0; i < histogram.shares.size(); ++i) {
    if (!(histogram.shares[i] > 0)) continue;
    Bin bin;
    bin.lower = histogram.lower + width * static_cast<double>(i);
    bin.upper = histogram.lower + width * static_cast<double>(i + 1);
    bin.from = number_text(bin.lower);
    bin.to = number_text(bin.upper);
    bin.key = fmt::format("{}-{}", figure.id, i);
    bin.share = histogram.shares[i];
    bins.push_back(std::move(bin));
  }
  return bins;
}

std::string table_of(const HistogramFigure& figure, const std::vector<Bin>& bins) {
  const ValueSketch::Histogram& histogram = figure.histogram;
  HtmlTable table{"Columns of the plot: " + figure.x_title + ".",
                  {{"", "from"}, {"", "to"}, {"", figure.y_title}},
                  {}};
  const auto add = [&table](std::string key, std::string from, std::string to, double share) {
    table.rows.push_back(
        {std::move(key), false, {}, {std::move(from), std::move(to), share_text(share)}});
  };
  if (histogram.below > 0) add("", "below", number_text(histogram.lower), histogram.below);
  for (const Bin& bin : bins) add(bin.key, bin.from, bin.to, bin.share);
  if (histogram.above > 0) add("", number_text(histogram.upper), "above", histogram.above);
  return table_html(table);
}

}  // namespace

std::string histogram_html(const HistogramFigure& figure, const ColourScale& colours,
                           std::map<std::string, HtmlFigures>& figures) {
  const ValueSketch::Histogram& histogram = figure.histogram;
  ColumnPlot plot{
      figure.id,
      figure.title,
      figure.description,
      PlotAxis::between(figure.x_title, histogram.lower, histogram.upper, short_text),
      PlotAxis::linear(figure.y_title, *std::ranges::max_element(histogram.shares), tick_percent),
      {{figure.title, PlotShape::kSquare}},
      {},
      figure.marks,
      {},
      {}};
  const std::vector<Bin> bins = bins_of(figure);
  for (const Bin& bin : bins) {
    plot.columns.push_back({bin.lower, bin.upper, bin.share, {}, 0, bin.key});
    figures[bin.key] = {fmt::format("{} to {}", bin.from, bin.to),
                        {{figure.y_title, share_text(bin.share)}}};
  }
  const auto note = [&plot](double share, const char* where, double value) {
    if (share > 0)
      plot.notes.push_back(fmt::format("{:.3g} % {} {}", 100 * share, where, number_text(value)));
  };
  note(histogram.below, "below", histogram.lower);
  note(histogram.above, "above", histogram.upper);
  for (int i = 0; i < kBandCells; ++i)
    plot.band.push_back(css_colour(colours.colour(
        histogram.lower + (histogram.upper - histogram.lower) * (i + 0.5) / kBandCells)));
  return column_plot_html(plot) + table_of(figure, bins);
}

}  // namespace planetree::tools
