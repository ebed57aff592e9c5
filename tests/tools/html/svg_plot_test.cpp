#include "tools/html/svg_plot.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "tests/tools/html/html_counts.h"
#include "tools/html/html_text.h"
#include "tools/html/plot_layout.h"

namespace planetree::tools {
namespace {

SvgPlot sample_plot() {
  SvgPlot plot;
  plot.id = "sample";
  plot.title = "Rates";
  plot.description = "Rates against errors";
  plot.x = PlotAxis::logarithmic("error", std::vector<double>{0, 1e-4, 1e-2}, 1e-9, short_text);
  plot.y = PlotAxis::logarithmic("rate", std::vector<double>{1e5, 1e6}, 1, short_text);
  plot.series = {{"exact", PlotShape::kDiamond}, {"error", PlotShape::kCircle}};
  const auto add = [&plot](double x, double y, std::size_t series, bool is_muted) {
    PlotPoint point;
    point.x = x;
    point.y = y;
    point.series = series;
    point.key = "key" + std::to_string(plot.points.size());
    point.label = is_muted ? "" : point.key;
    point.is_muted = is_muted;
    plot.points.push_back(point);
  };
  add(0, 2e5, 0, false);
  add(1e-4, 5e5, 1, false);
  add(1e-3, 4e5, 1, true);
  add(1e-2, 9e5, 1, false);
  return plot;
}

TEST(SvgPlot, DrawsEachPointOnceAndGreyOnesFirst) {
  const std::string html = plot_html(sample_plot());
  EXPECT_EQ(count_of(html, "data-key="), 4);
  EXPECT_EQ(count_of(html, "class=\"point c1 muted\""), 1);
  EXPECT_LT(html.find("key2"), html.find("key0"));
}

TEST(SvgPlot, HasATextInstead) {
  const std::string html = plot_html(sample_plot());
  EXPECT_EQ(count_of(html,
                     "role=\"img\" tabindex=\"0\" "
                     "aria-labelledby=\"sample-title sample-desc\""),
            1);
  EXPECT_EQ(count_of(html, "<title id=\"sample-title\">Rates</title>"), 1);
  EXPECT_EQ(count_of(html, "<desc id=\"sample-desc\">Rates against errors</desc>"), 1);
}

TEST(SvgPlot, NamesTheSeriesAndWhatGreyMeans) {
  SvgPlot plot = sample_plot();
  EXPECT_EQ(count_of(plot_html(plot), "<li>"), 2);
  plot.muted_note = "dominated";
  plot.hollow_note = "median";
  EXPECT_EQ(count_of(plot_html(plot), "<li>"), 4);
}

TEST(SvgPlot, JoinsPointsThatAreNotGreyBySteps) {
  SvgPlot plot = sample_plot();
  EXPECT_EQ(count_of(plot_html(plot), "class=\"steps\""), 0);
  plot.has_steps = true;
  const std::string html = plot_html(plot);
  const std::size_t at = html.find("class=\"steps\"");
  const std::string steps = html.substr(at, html.find("/>", at) - at);
  EXPECT_EQ(count_of(steps, "V"), 2);
  EXPECT_EQ(count_of(steps, "H"), 3) << "the last leads to the end of the axis";
}

TEST(SvgPlot, JoinsThePointsOfASeriesByLines) {
  SvgPlot plot = sample_plot();
  EXPECT_EQ(count_of(plot_html(plot), "class=\"line"), 0);
  plot.has_lines = true;
  const std::string html = plot_html(plot);
  EXPECT_EQ(count_of(html, "class=\"line c"), 2) << "one a series";
  const std::size_t at = html.find("class=\"line c1\"");
  const std::string line = html.substr(at, html.find("/>", at) - at);
  EXPECT_EQ(count_of(line, "L"), 2);
}

TEST(SvgPlot, EscapesItsTexts) {
  SvgPlot plot = sample_plot();
  plot.title = plot.description = plot.muted_note = plot.points[0].label = "<a&\">";
  plot.points[0].key = plot.series[0].name = "<a&\">";
  const std::string html = plot_html(plot);
  EXPECT_EQ(count_of(html, "<a"), 0);
  EXPECT_GE(count_of(html, "&lt;a&amp;&quot;&gt;"), 6);
}

TEST(PlotLayout, MovesPointsOfTheLaneApart) {
  SvgPlot plot = sample_plot();
  for (int i = 0; i < 4; ++i) plot.points.push_back(plot.points[0]);
  const PlotLayout layout = lay_out(plot);
  int apart = 0, pairs = 0;
  for (std::size_t i = 4; i < 8; ++i)
    for (std::size_t k = i + 1; k < 8; ++k, ++pairs)
      apart += std::abs(layout.points[i].x - layout.points[k].x) >= 2 * kPlotShapeReach;
  EXPECT_EQ(apart, pairs);
  for (const PlotPlace& place : layout.points) EXPECT_GE(place.x, layout.frame.left);
}

TEST(PlotLayout, WritesLabelsOnlyWhereTheyHaveRoom) {
  SvgPlot plot = sample_plot();
  EXPECT_EQ(lay_out(plot).labels.size(), 3u);
  for (int i = 0; i < 40; ++i) {
    plot.points.push_back(plot.points[1]);
    plot.points.back().y *= 1 + 0.001 * i;
  }
  const PlotLayout layout = lay_out(plot);
  EXPECT_LT(layout.labels.size(), 20u);
  EXPECT_GE(layout.labels.size(), 3u);
  for (std::size_t i = 0; i < layout.labels.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_TRUE(std::string_view(layout.labels[i].anchor) != layout.labels[k].anchor ||
                  std::abs(layout.labels[i].y - layout.labels[k].y) > 10 ||
                  std::abs(layout.labels[i].x - layout.labels[k].x) > 10);
}

}  // namespace
}  // namespace planetree::tools
