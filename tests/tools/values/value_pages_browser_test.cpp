// The pages of comparisons and of thickness as a reader sees them, in a browser without a window.

#include <gtest/gtest.h>

#include <string>

#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/html/browser.h"
#include "tests/tools/html/examine_layout.h"
#include "tools/compare/compare_page.h"
#include "tools/thickness/thickness_page.h"

namespace planetree::tools {
namespace {

constexpr const char* kName = "</script><b>a\xFF.csv";

CompareRecord sample_comparison(double scale, bool is_signed) {
  CompareRecord record{.file = "scan.ptree",
                       .other = kName,
                       .model_triangles = 1234567,
                       .diagonal = 100 * scale,
                       .deviations = DeviationTally(100 * scale, is_signed, 2 * scale),
                       .mesh = ComparedMesh{},
                       .hausdorff = {}};
  for (int i = 0; i < 2000; ++i) {
    ClosestPoint answer;
    answer.distance = scale * (i % 97) * (i % 89) / 1700;
    answer.lower = answer.upper = answer.distance;
    answer.side = i % 3 == 0 ? Side::kInside : Side::kOutside;
    answer.status = Status::kExact;
    record.deviations.add({-123.456 * scale, 1e-5 * i, 7}, answer);
  }
  record.hausdorff = record.deviations.hausdorff();
  record.reach = default_reach(record.deviations);
  return record;
}

ThicknessRecord sample_thickness(double scale) {
  ThicknessRecord record{.file = kName,
                         .points = {},
                         .options = {},
                         .thin = 0.5 * scale,
                         .sketch = ValueSketch(100 * scale),
                         .thinnest = {}};
  for (int i = 1; i < 2000; ++i) {
    WallThickness wall;
    wall.thickness = wall.lower = wall.upper = scale * (i % 97) * (1 + i % 7) / 100;
    wall.has_contact = true;
    wall.status = ThicknessStatus::kExact;
    record.add(wall, 1);
  }
  return record;
}

class ValuePagesInBrowser : public testing::Test {
 protected:
  void SetUp() override {
    if (!Browser::is_here()) GTEST_SKIP() << Browser::kMissing;
  }
  nlohmann::json examined(const std::string& html, const std::string& examination,
                          const BrowserWindow& window) {
    BrowserVisit visit = Browser::visit(html, examination, window, folder_ / ".");
    for (const std::string& complaint : visit.complaints) ADD_FAILURE() << complaint;
    for (const std::string& request : visit.requests) ADD_FAILURE() << "asks for " << request;
    return visit.report;
  }
  void expect_fits(const std::string& html, const BrowserWindow& window) {
    const auto report = examined(html, kExamineLayout, window);
    ASSERT_TRUE(report.is_object());
    EXPECT_LE(report["scrollWidth"], window.width) << "the page scrolls sideways";
    EXPECT_EQ(report["isDark"], window.is_dark);
    EXPECT_EQ(report["covered"], nlohmann::json::array()) << window.width;
    EXPECT_EQ(report["cut"], nlohmann::json::array()) << window.width;
    EXPECT_EQ(report["faint"], nlohmann::json::array()) << window.is_dark;
  }

  storage::TemporaryDirectory folder_;
};

TEST_F(ValuePagesInBrowser, FitWindowsInBothThemesAtAnyScale) {
  const std::string signed_page = compare_page(sample_comparison(1, true), "planetree");
  const std::string small_page = compare_page(sample_comparison(1.2e-7, true), "planetree");
  const std::string large_page = thickness_page(sample_thickness(3.1e6), "planetree");
  for (const int width : {390, 1440}) {
    expect_fits(signed_page, {width, width == 390});
    expect_fits(small_page, {width, false});
    expect_fits(large_page, {width, true});
  }
}

TEST_F(ValuePagesInBrowser, HaveAColumnAndARowForEachRangeAndTheirColours) {
  const auto report = examined(compare_page(sample_comparison(1, true), "planetree"), R"js(
    const columns = [...document.querySelectorAll('#deviations .point')];
    const row = (key) => document.querySelector(`tr[data-key="${key}"]`);
    const svg = document.querySelector('#deviations');
    const tip = svg.parentElement.querySelector('.tip'), last = columns[columns.length - 1];
    svg.parentElement.scrollIntoView();
    const box = last.querySelector('.hit').getBoundingClientRect();
    svg.dispatchEvent(new PointerEvent('pointermove', {bubbles: true,
      clientX: (box.left + box.right) / 2, clientY: box.top + 2}));
    return {
      columns: columns.length,
      rows: columns.filter((column) => row(column.dataset.key)).length,
      over: tip.innerText, lit: row(last.dataset.key).classList.contains('lit'),
      marks: document.querySelectorAll('#deviations .mark').length,
      colours: document.querySelectorAll('#deviations rect[fill]').length,
      title: document.querySelector('h1').innerText, bold: document.querySelectorAll('b').length,
    })js",
                               {1440, false});
  ASSERT_TRUE(report.is_object());
  EXPECT_GT(report["columns"], 50);
  EXPECT_EQ(report["rows"], report["columns"]);
  EXPECT_NE(report["over"].get<std::string>().find("share of the area"), std::string::npos)
      << report["over"] << " is above the column, but within its area";
  EXPECT_EQ(report["lit"], true);
  EXPECT_EQ(report["marks"], 2) << "the tolerance on both sides";
  EXPECT_EQ(report["colours"], 64);
  EXPECT_EQ(report["title"], "</script><b>a\xEF\xBF\xBD.csv");
  EXPECT_EQ(report["bold"], 0);
}

}  // namespace
}  // namespace planetree::tools
