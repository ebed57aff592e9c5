#include "tools/html/heat_strip.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/tools/html/html_counts.h"
#include "tools/html/html_text.h"

namespace planetree::tools {
namespace {

HeatStrip sample_strip() {
  HeatStrip strip;
  strip.id = "strip";
  strip.title = "Pages <looked up>";
  strip.description = "Where & when";
  strip.x = PlotAxis::linear("seconds", 4, short_text);
  strip.x_end = 4;
  strip.y_title = "octcode";
  strip.legend = "dark: all";
  strip.columns = 4;
  strip.rows = 2;
  strip.values = {0, 1, 1, 0, 0.5F, 0, 0, 7};
  return strip;
}

TEST(HeatStrip, DrawsNeighboursOfOneShadeAsOneCell) {
  const std::string html = strip_html(sample_strip());
  EXPECT_EQ(count_of(html, "class=\"cell\""), 2) << "a path a shade";
  EXPECT_EQ(count_of(html,
                     "fill-opacity=\"1.00\" d=\"M129.0 116.0h222.0v88.0h-222.0Z"
                     "M351.0 28.0h111.0v88.0h-111.0Z\""),
            1)
      << html;
  EXPECT_EQ(count_of(html, "fill-opacity=\"0.50\" d=\"M18.0 28.0h111.0v88.0h-111.0Z\""), 1);
}

TEST(HeatStrip, HasAnAreaForTheFiguresOfEachColumn) {
  EXPECT_EQ(count_of(strip_html(sample_strip()), "data-key="), 0);
  HeatStrip strip = sample_strip();
  strip.keys = {"w0", "w1", "w2", "w3"};
  const std::string html = strip_html(strip);
  EXPECT_EQ(count_of(html, "data-key=\"w3\"><rect class=\"shape hit column\" x=\"351.0\""), 1);
  EXPECT_EQ(count_of(html, "data-key="), 4);
}

TEST(HeatStrip, EscapesItsTexts) {
  const std::string html = strip_html(sample_strip());
  EXPECT_EQ(count_of(html, "Pages &lt;looked up&gt;"), 2);
  EXPECT_EQ(count_of(html, "Where &amp; when"), 1);
}

}  // namespace
}  // namespace planetree::tools
