#include "tools/html/column_plot.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/tools/html/html_counts.h"
#include "tools/html/bar_plot.h"
#include "tools/html/html_text.h"

namespace planetree::tools {
namespace {

ColumnPlot sample_columns() {
  return {"columns",
          "Sizes <of pages>",
          "What is here",
          PlotAxis::linear("bytes", 40, short_text),
          PlotAxis::linear("pages", 4, short_text),
          {{"small", PlotShape::kSquare}, {"large", PlotShape::kTriangle}},
          {{0, 10, 4, {}, 0, "a"}, {10, 20, 0, {}, 0, "b"}, {20, 40, 2, 1, 1, "c\""}},
          {},
          {},
          {}};
}

TEST(ColumnPlot, DrawsAColumnFromItsBottomToItsValue) {
  const std::string html = column_plot_html(sample_columns());
  EXPECT_EQ(count_of(html, "class=\"shape column\""), 2) << "none for 0";
  // The drawing has 392 by 200 units for 40 bytes and 4 pages, and its lower left is 70, 234.
  EXPECT_EQ(count_of(html, "x=\"70.30\" y=\"34.00\" width=\"97.40\" height=\"200.00\""), 1) << html;
  EXPECT_EQ(count_of(html, "x=\"266.30\" y=\"134.00\" width=\"195.40\" height=\"50.00\""), 1);
  EXPECT_EQ(count_of(html, "data-key=\"c&quot;\""), 1);
}

TEST(ColumnPlot, ShowsSeriesByShapesToo) {
  const std::string html = column_plot_html(sample_columns());
  EXPECT_EQ(count_of(html, "transform=\"translate(364.0 134.0)\""), 1);
  EXPECT_EQ(count_of(html, "<li>"), 2);
  ColumnPlot plot = sample_columns();
  plot.series.resize(1);
  plot.columns.pop_back();
  EXPECT_EQ(count_of(column_plot_html(plot), "<li>"), 0);
}

TEST(ColumnPlot, MarksValuesOnItsAxisAlone) {
  ColumnPlot plot = sample_columns();
  plot.marks = {{20, "limit"}, {41, "limit"}, {-1, "limit"}};
  plot.notes = {"1 % above 40"};
  plot.band = {"#000001", "#000002"};
  const std::string html = column_plot_html(plot);
  EXPECT_EQ(count_of(html, "class=\"mark dashed\" d=\"M266.0 34V"), 1);
  EXPECT_EQ(count_of(html, "class=\"mark dashed\""), 1);
  EXPECT_EQ(count_of(html, "<li>dashes: limit</li>"), 1);
  EXPECT_EQ(count_of(html, "<li>1 % above 40</li>"), 1);
  EXPECT_EQ(count_of(html, "fill=\"#00000"), 2);
}

TEST(BarPlot, HasABarANameAndALabelForEachPart) {
  const BarPlot plot{
      "bars",
      "Bytes",
      "What is here",
      PlotAxis::linear("bytes", 4, short_text),
      {{"a<b", 4, "four", "k0"}, {"none", 0, "0 B", "k1"}, {"half", 2, "two", "k2"}}};
  const std::string html = bar_plot_html(plot);
  EXPECT_EQ(count_of(html, ">a&lt;b</text>"), 1);
  EXPECT_EQ(count_of(html, ">four</text>"), 1);
  EXPECT_EQ(count_of(html, "class=\"point c0\" data-key=\"k"), 3);
  EXPECT_EQ(count_of(html, "width=\"262.00\""), 1) << "the whole axis";
  EXPECT_EQ(count_of(html, "width=\"131.00\""), 1);
  EXPECT_EQ(count_of(html, "width=\"0.50\""), 1) << "0 can be seen";
}

}  // namespace
}  // namespace planetree::tools
