// The page of a tune as a reader sees it, in a browser without a window.

#include <gtest/gtest.h>

#include <string>

#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/html/browser.h"
#include "tests/tools/html/examine_layout.h"
#include "tests/tools/tune/sample_tune_record.h"
#include "tools/tune/tune_page.h"

namespace planetree::tools {
namespace {

class TunePageInBrowser : public testing::Test {
 protected:
  void SetUp() override {
    if (!Browser::is_here()) GTEST_SKIP() << Browser::kMissing;
  }
  nlohmann::json examined(const TuneRecord& record, const std::string& examination,
                          const BrowserWindow& window = {}) {
    BrowserVisit visit =
        Browser::visit(tune_page(record, "planetree"), examination, window, folder_ / ".");
    for (const std::string& complaint : visit.complaints) ADD_FAILURE() << complaint;
    for (const std::string& request : visit.requests) ADD_FAILURE() << "asks for " << request;
    return visit.report;
  }

  storage::TemporaryDirectory folder_;
};

TEST_F(TunePageInBrowser, FitsWindowsOfAnyWidthInBothThemes) {
  const TuneRecord record = sample_tune_record("</script><b>a\xFF.trace");
  for (const int width : {390, 1440})
    for (const bool is_dark : {false, true}) {
      const auto report = examined(record, kExamineLayout, {width, is_dark});
      ASSERT_TRUE(report.is_object());
      EXPECT_LE(report["scrollWidth"], width) << "the page scrolls sideways";
      EXPECT_EQ(report["isDark"], is_dark);
      EXPECT_EQ(report["covered"], nlohmann::json::array()) << width;
      EXPECT_EQ(report["cut"], nlohmann::json::array()) << width;
      EXPECT_EQ(report["faint"], nlohmann::json::array()) << is_dark;
    }
}

TEST_F(TunePageInBrowser, HasAPointForEachFigureAndARowForEachPoint) {
  const TuneRecord record = sample_tune_record("</script><b>a\xFF.trace");
  const auto report = examined(record, R"js(
    const count = (id) => document.querySelectorAll('#' + id + ' .point').length;
    const keys = [...document.querySelectorAll('svg.plot .point')].map((p) => p.dataset.key);
    const rows = new Set([...document.querySelectorAll('tr[data-key]')].map((r) => r.dataset.key));
    return {
      misses: count('misses'), set: count('working-set'), degraded: count('felt-degraded'),
      width: count('felt-width'), ticks: count('felt-ticks'),
      lines: document.querySelectorAll('#misses .line').length,
      cells: ['looked-up', 'resident'].map(
        (id) => document.querySelectorAll('#' + id + ' .cell').length > 1),
      lost: keys.filter((key) => !rows.has(key)),
      bold: document.querySelectorAll('b').length,
    })js");
  ASSERT_TRUE(report.is_object());
  const std::size_t windows = record.timeline.windows().size();
  EXPECT_EQ(report["misses"], 6 * record.curves.frames.size());
  EXPECT_EQ(report["lines"], 6);
  EXPECT_EQ(report["set"], 2 * windows);
  EXPECT_EQ(report["degraded"], record.felt.size());
  EXPECT_EQ(report["width"], record.felt.size());
  EXPECT_EQ(report["ticks"], record.felt.size());
  EXPECT_EQ(report["cells"], (nlohmann::json{true, true}));
  EXPECT_EQ(report["lost"], nlohmann::json::array());
  EXPECT_EQ(report["bold"], 0);
}

TEST_F(TunePageInBrowser, SaysWhatItLacks) {
  TuneRecord record = sample_tune_record("a.trace");
  record.felt.clear();
  record.recommended.reset();
  record.prefetch = {};
  const auto report = examined(record, R"js(return {text: document.body.innerText};)js");
  ASSERT_TRUE(report.is_object());
  const std::string text = report["text"];
  EXPECT_NE(text.find("was not replayed"), std::string::npos);
  EXPECT_NE(text.find("No page was read for a motion"), std::string::npos);
  EXPECT_NE(text.find("knee of clock's curve"), std::string::npos);
}

}  // namespace
}  // namespace planetree::tools
