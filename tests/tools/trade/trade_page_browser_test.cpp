// The page of a trade as a reader sees it, in a browser without a window.

#include <gtest/gtest.h>

#include <string>

#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/html/browser.h"
#include "tests/tools/html/examine_layout.h"
#include "tests/tools/trade/sample_record.h"
#include "tools/trade/trade_page.h"

namespace planetree::tools {
namespace {

class TradePageInBrowser : public testing::Test {
 protected:
  void SetUp() override {
    if (!Browser::is_here()) GTEST_SKIP() << Browser::kMissing;
  }
  nlohmann::json examined(const std::string& examination, const BrowserWindow& window = {}) {
    return examined(sample_record("</script><b>a\xFF.ptree"), examination, window);
  }
  nlohmann::json examined(const TradeRecord& record, const std::string& examination,
                          const BrowserWindow& window) {
    const std::string html = trade_page(record, "planetree");
    BrowserVisit visit = Browser::visit(html, examination, window, folder_ / ".");
    for (const std::string& complaint : visit.complaints) ADD_FAILURE() << complaint;
    for (const std::string& request : visit.requests) ADD_FAILURE() << "asks for " << request;
    return visit.report;
  }

  storage::TemporaryDirectory folder_;
};

TEST_F(TradePageInBrowser, FitsWindowsOfAnyWidthInBothThemes) {
  for (const int width : {390, 768, 1440})
    for (const bool is_dark : {false, true}) {
      const auto report = examined(kExamineLayout, {width, is_dark});
      ASSERT_TRUE(report.is_object());
      EXPECT_EQ(report["width"], width);
      EXPECT_LE(report["scrollWidth"], width) << "the page scrolls sideways";
      EXPECT_EQ(report["isDark"], is_dark);
      EXPECT_EQ(report["covered"], nlohmann::json::array()) << width;
      EXPECT_EQ(report["cut"], nlohmann::json::array()) << width;
      EXPECT_EQ(report["faint"], nlohmann::json::array()) << is_dark;
    }
}

TEST_F(TradePageInBrowser, HasRoomForTheTicksOfAnySpan) {
  TradeRecord record = sample_record(std::string(200, 'a') + ".ptree");
  std::erase_if(record.rows, [&](const TradeRow& row) {
    return row.setting.max_error > 0 && row.setting.max_error < 9e-4 * record.diagonal;
  });
  for (const double factor : {1.0, 20.0}) {
    for (TradeRow& row : record.rows)
      for (TradeResult& result : row.results) {
        result.seconds *= factor;
        result.promised.p50 /= factor;
        result.promised.p99 /= factor;
      }
    for (const int width : {390, 1440}) {
      const auto report = examined(record, kExamineLayout, {width, false});
      ASSERT_TRUE(report.is_object());
      EXPECT_LE(report["scrollWidth"], width);
      EXPECT_EQ(report["covered"], nlohmann::json::array()) << width;
      EXPECT_EQ(report["cut"], nlohmann::json::array()) << width;
    }
  }
}

TEST_F(TradePageInBrowser, HasAPointForEachSettingAndARowForEachPoint) {
  const auto report = examined(R"js(
    const count = (id) => document.querySelectorAll('#' + id + ' .point').length;
    const keys = [...document.querySelectorAll('svg.plot .point')].map((p) => p.dataset.key);
    const rows = new Set([...document.querySelectorAll('tr[data-key]')].map((r) => r.dataset.key));
    return {
      rate: ['uniform', 'near', 'path'].map((workload) => count(workload + '-rate')),
      pages: ['uniform', 'near', 'path'].map((workload) => count(workload + '-pages')),
      width: count('paced-width'), degraded: count('paced-degraded'),
      lost: keys.filter((key) => !rows.has(key)),
      title: document.querySelector('h1').innerText, bold: document.querySelectorAll('b').length,
    })js");
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["rate"], (nlohmann::json{15, 15, 15}));
  EXPECT_EQ(report["pages"], (nlohmann::json{15, 15, 15}));
  EXPECT_EQ(report["width"], 2 * 2 * 3) << "a median and a quantile a budget and workload";
  EXPECT_EQ(report["degraded"], 2 * 3);
  EXPECT_EQ(report["lost"], nlohmann::json::array());
  EXPECT_EQ(report["title"], "</script><b>a\xEF\xBF\xBD.ptree");
  EXPECT_EQ(report["bold"], 0);
}

TEST_F(TradePageInBrowser, ShowsTheFiguresOfThePointUnderThePointer) {
  const auto report = examined(R"js(
    const canvas = document.querySelector('#uniform-rate').parentElement;
    const svg = canvas.querySelector('svg'), tip = canvas.querySelector('.tip');
    const point = svg.querySelector('[data-key="uniform-8"]');
    canvas.scrollIntoView();
    const box = point.getBoundingClientRect();
    const at = {bubbles: true, clientX: box.left + box.width / 2, clientY: box.top + box.height / 2};
    const text = () => getComputedStyle(tip).display === 'none' ? '' : tip.innerText;
    const send = (kind, more) => svg.dispatchEvent(new PointerEvent(kind, {...at, ...more}));
    const before = text();
    send('pointermove');
    const over = text(), lit = document.querySelectorAll('tr.lit').length;
    const inside = tip.getBoundingClientRect().right <= innerWidth;
    send('pointermove', {clientY: box.top - 200});
    const beside = text();
    send('pointermove');
    send('pointerleave', {pointerType: 'mouse'});
    const left = text();
    send('pointerdown', {pointerType: 'touch'});
    send('pointerleave', {pointerType: 'touch'});
    return {before, over, lit, inside, beside, left, tapped: text()};)js",
                               {390, false});
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["before"], "");
  const std::string over = report["over"];
  EXPECT_NE(over.find("work 8, uniform"), std::string::npos) << over;
  for (const char* figure : {"queries a second", "2.00 M", "promised error p99", "1.5e-2",
                             "true error p99", "broken answers", "options", "--max-work 8"})
    EXPECT_NE(over.find(figure), std::string::npos) << figure << " is not in " << over;
  EXPECT_EQ(report["lit"], 1) << "the row of the point";
  EXPECT_EQ(report["inside"], true);
  EXPECT_EQ(report["beside"], "");
  EXPECT_EQ(report["left"], "");
  EXPECT_EQ(report["tapped"], over);
}

TEST_F(TradePageInBrowser, ShowsFiguresByTheKeyboard) {
  const auto report = examined(R"js(
    const canvas = document.querySelector('#uniform-rate').parentElement;
    const svg = canvas.querySelector('svg'), tip = canvas.querySelector('.tip');
    const press = (key) => {
      svg.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true}));
      return tip.classList.contains('shown') ? tip.querySelector('strong').innerText : '';
    };
    svg.focus();
    press('Escape');
    const titles = [];
    for (let i = 0; i < 16; ++i) titles.push(press('ArrowRight'));
    const back = press('ArrowLeft'), gone = press('Escape');
    return {focused: document.activeElement === svg, titles, back, gone};)js");
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["focused"], true);
  const std::vector<std::string> titles = report["titles"];
  EXPECT_EQ(std::set<std::string>(titles.begin(), titles.end()).size(), 15u) << "each point once";
  EXPECT_EQ(titles.back(), titles.front());
  EXPECT_EQ(report["back"], titles[14]);
  EXPECT_EQ(report["gone"], "");
}

}  // namespace
}  // namespace planetree::tools
