#include "tools/trade/trade_page.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/tools/html/html_counts.h"
#include "tests/tools/trade/sample_record.h"
#include "tools/trade/trade_arguments.h"
#include "tools/trade/trade_figures.h"
#include "tools/trade/trade_plots.h"

namespace planetree::tools {
namespace {

TEST(TradePage, HasAPlotOfRatesAndOneOfPagesForEachWorkload) {
  const std::string html = trade_page(sample_record("scan.ptree"), "planetree trade scan.ptree");
  for (const char* id : {"uniform-rate", "uniform-pages", "near-rate", "near-pages", "path-rate",
                         "path-pages", "paced-width", "paced-degraded"})
    EXPECT_EQ(count_of(html, std::string("<svg class=\"plot\" id=\"") + id + '"'), 1) << id;
  EXPECT_EQ(count_of(html, "<svg class=\"plot\""), 8);
  EXPECT_EQ(count_of(html, "<table>"), 3 + 2) << "recommendations, workloads, without waiting";
}

TEST(TradePage, EndsWithTheCommandsToUse) {
  const std::string html = trade_page(sample_record("my scan.ptree"), "planetree trade again");
  EXPECT_EQ(count_of(html, "planetree query &#39;my scan.ptree&#39; POINTS --max-error "), 4);
  EXPECT_EQ(count_of(html, "<code>planetree trade again</code>"), 1);
  EXPECT_EQ(count_of(html, "<td class=\"number\">0 of 6,000</td>"), 4) << "broken intervals";
}

TEST(TradePage, DoesWithoutWhatWasNotMeasured) {
  TradeRecord record = sample_record("scan.ptree");
  record.median_edge = 0;
  record.workloads = {TradeWorkload::kGiven};
  std::erase_if(record.rows, [](const TradeRow& row) { return row.setting.wait == Wait::kNever; });
  for (TradeRow& row : record.rows) row.results.resize(1);
  const std::string html = trade_page(record, "planetree trade");
  EXPECT_EQ(count_of(html, "<svg class=\"plot\""), 2);
  EXPECT_EQ(count_of(html, "median edge"), 0);
  EXPECT_EQ(count_of(html, "Not measured within 400 KiB"), 1);
}

TEST(TradePlots, HaveAScaleInMedianEdges) {
  const TradeRecord record = sample_record("scan.ptree");
  const SvgPlot plot = rate_plot(record, 0);
  ASSERT_TRUE(plot.upper_x);
  EXPECT_NEAR(plot.upper_x->place(1), plot.x.place(record.median_edge / record.diagonal), 1e-12);
}

TEST(TradePlots, AreGreyWhereAnotherSettingOfTheWorkloadIsBetter) {
  const TradeRecord record = sample_record("scan.ptree");
  const SvgPlot plot = rate_plot(record, 0);
  for (const PlotPoint& point : plot.points)
    for (const PlotPoint& other : plot.points) {
      const bool is_better = other.x < point.x && other.y > point.y && !plot.x.is_in_lane(point.x);
      EXPECT_TRUE(!is_better || point.is_muted) << point.key << " beside " << other.key;
    }
  EXPECT_TRUE(plot.points.back().is_muted);
  EXPECT_FALSE(plot.points.front().is_muted);
}

TEST(IsDominated, TakesRoundingForNoError) {
  TradeRecord record = sample_record("scan.ptree");
  TradeResult& exact = record.rows[0].results[0];
  TradeResult& other = record.rows.back().results[0];
  record.rows.back().setting.wait = Wait::kForPages;
  other = exact;
  other.promised.p99 = exact.promised.p99 / 2;
  other.seconds = 2 * exact.seconds;
  EXPECT_TRUE(is_dominated(record, record.rows.back(), 0));
  EXPECT_FALSE(is_dominated(record, record.rows.front(), 0));
}

TEST(TradeCommand, LeavesOutWhatIsDefault) {
  TradeArguments arguments;
  arguments.file = "my scan.ptree";
  arguments.page.html = "out.html";
  EXPECT_EQ(trade_command(arguments), "planetree trade 'my scan.ptree' --html out.html --force");
  arguments.points = "points.csv";
  arguments.count = 50;
  arguments.memory_bytes = 4096;
  arguments.parts = kDistance;
  EXPECT_EQ(trade_command(arguments),
            "planetree trade 'my scan.ptree' --points points.csv --count 50 --memory 4096 --parts "
            "distance --html out.html --force");
}

}  // namespace
}  // namespace planetree::tools
