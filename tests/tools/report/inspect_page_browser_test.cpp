// The page about a file as a reader sees it, in a browser without a window.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/check/sample_tree.h"
#include "tests/tools/html/browser.h"
#include "tests/tools/html/examine_layout.h"
#include "tests/tools/html/html_counts.h"
#include "tools/report/inspect_page.h"
#include "tools/report/summary_report.h"

namespace planetree::tools {
namespace {

const std::string kSamples = PLANETREE_SOURCE_DIR "/format-spec/v1/samples/";

InspectRecord record_of(const std::filesystem::path& file) {
  auto parts = FileParts::open(file);
  EXPECT_TRUE(parts);
  InspectRecord record{"</script><b>a\xFF.ptree", {}, {}, PageTally(*parts)};
  record.survey = survey_file(*parts, [&record](const PageRow& row) {
    record.pages.add(row);
    return true;
  });
  record.summary = summary_json(*parts, record.survey);
  return record;
}

class InspectPageInBrowser : public testing::Test {
 protected:
  void SetUp() override {
    if (!Browser::is_here()) GTEST_SKIP() << Browser::kMissing;
  }
  nlohmann::json examined(const InspectRecord& record, const std::string& examination,
                          const BrowserWindow& window) {
    BrowserVisit visit =
        Browser::visit(inspect_page(record, "planetree"), examination, window, folder_ / ".");
    for (const std::string& complaint : visit.complaints) ADD_FAILURE() << complaint;
    for (const std::string& request : visit.requests) ADD_FAILURE() << "asks for " << request;
    return visit.report;
  }
  void expect_fits(const InspectRecord& record, const BrowserWindow& window) {
    const auto report = examined(record, kExamineLayout, window);
    ASSERT_TRUE(report.is_object());
    EXPECT_LE(report["scrollWidth"], window.width) << "the page scrolls sideways";
    EXPECT_EQ(report["isDark"], window.is_dark);
    EXPECT_EQ(report["covered"], nlohmann::json::array()) << window.width;
    EXPECT_EQ(report["cut"], nlohmann::json::array()) << window.width;
    EXPECT_EQ(report["faint"], nlohmann::json::array()) << window.is_dark;
  }
  /// The sample with a byte of each page but the first two changed.
  std::filesystem::path damaged() {
    auto bytes = storage::read_bytes(kSamples + "boxes.ptree");
    const auto parts = FileParts::open(kSamples + "boxes.ptree");
    EXPECT_TRUE(parts);
    for (std::uint32_t page = 2; page < parts->page_count(); ++page)
      bytes[parts->entries()[page].offset] ^= std::byte{1};
    storage::write_bytes(folder_ / "damaged.ptree", bytes);
    return folder_ / "damaged.ptree";
  }

  storage::TemporaryDirectory folder_;
};

TEST_F(InspectPageInBrowser, FitsWindowsOfAnyWidthInBothThemes) {
  const InspectRecord whole = record_of(kSamples + "boxes.ptree");
  const InspectRecord broken = record_of(damaged());
  for (const int width : {390, 768, 1440})
    for (const bool is_dark : {false, true}) {
      expect_fits(whole, {width, is_dark});
      expect_fits(broken, {width, is_dark});
    }
}

TEST_F(InspectPageInBrowser, HasARowAndFiguresForAllThatIsDrawn) {
  const InspectRecord record = record_of(kSamples + "boxes.ptree");
  const auto report = examined(record, R"js(
    const figures = JSON.parse(document.querySelector('#figures').textContent);
    const keys = [...document.querySelectorAll('svg.plot .point')].map((p) => p.dataset.key);
    const rows = new Set([...document.querySelectorAll('tr[data-key]')].map((r) => r.dataset.key));
    const count = (id) => document.querySelectorAll('#' + id + ' .point').length;
    return {
      lost: keys.filter((key) => !rows.has(key) || !figures[key]),
      plots: [...document.querySelectorAll('svg.plot')].map((svg) => svg.id),
      sections: count('sections'), depths: count('depths'), mask: count('mask-levels'),
      windows: count('compression'),
      title: document.querySelector('h1').innerText, bold: document.querySelectorAll('b').length,
    })js",
                               {1440, false});
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["lost"], nlohmann::json::array());
  EXPECT_EQ(report["plots"], (nlohmann::json{"sections", "streams", "depths", "depth-bytes",
                                             "mask-levels", "page-sizes", "compression"}));
  EXPECT_GE(report["sections"], 4) << "headers, page table, distance pages and mask pages";
  EXPECT_EQ(report["depths"], 3 * record.survey.levels.size());
  EXPECT_EQ(report["mask"], 5 * record.survey.mask.size());
  EXPECT_EQ(report["windows"].dump(), record.summary["pages"].dump());
  EXPECT_EQ(report["title"], "</script><b>a\xEF\xBF\xBD.ptree");
  EXPECT_EQ(report["bold"], 0);
}

TEST_F(InspectPageInBrowser, ShowsFiguresByTheKeyboard) {
  const auto report = examined(record_of(kSamples + "boxes.ptree"), R"js(
    const svg = document.querySelector('#sections'), tip = svg.parentElement.querySelector('.tip');
    svg.focus();
    svg.dispatchEvent(new KeyboardEvent('keydown', {key: 'Escape'}));
    const titles = [];
    for (const bar of svg.querySelectorAll('.point')) {
      svg.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight'}));
      titles.push(tip.innerText);
    }
    return {titles, bars: [...svg.querySelectorAll('.point')].length,
            lit: document.querySelectorAll('tr.lit').length};)js",
                               {390, true});
  ASSERT_TRUE(report.is_object());
  const std::set<std::string> titles = report["titles"];
  EXPECT_EQ(titles.size(), report["bars"]) << "each bar once";
  for (const std::string& title : titles)
    EXPECT_NE(title.find("bytes a triangle"), std::string::npos) << title;
  EXPECT_EQ(report["lit"], 1);
}

TEST_F(InspectPageInBrowser, MarksUnreadablePagesAndListsIssues) {
  const InspectRecord record = record_of(damaged());
  const auto pages = record.summary["pages"].get<std::uint32_t>();
  EXPECT_EQ(record.pages.unreadable(), pages - 2);
  const std::string html = inspect_page(record, "planetree");
  EXPECT_EQ(count_of(html, ">PAGE_CHECKSUM</th>"), static_cast<int>(pages - 2));
  EXPECT_EQ(count_of(html, "<svg class=\"plot\" id=\"compression\""), 1);
  EXPECT_EQ(count_of(html, fmt::format("<p>{} pages cannot be read.</p>", pages - 2)), 1);
}

TEST(InspectPage, IsThereForAFileWithoutAHeader) {
  const storage::TemporaryDirectory folder;
  storage::write_bytes(folder / "no.ptree", std::vector<std::byte>(100));
  const std::string html = inspect_page(record_of(folder / "no.ptree"), "planetree <x>");
  EXPECT_EQ(count_of(html, "<dd>100 B</dd>"), 1);
  EXPECT_EQ(count_of(html, ">NOT_PLANETREE</th>"), 1);
  EXPECT_EQ(count_of(html, "<svg class=\"plot\""), 0);
  EXPECT_EQ(count_of(html, "planetree &lt;x&gt;"), 1);
}

TEST(PageTally, CountsEachPageOnceBySizeAndByPlace) {
  const InspectRecord record = record_of(kSamples + "boxes.ptree");
  std::uint64_t by_size = 0, by_place = 0, bytes = 0;
  for (const auto& bin : record.pages.sizes())
    for (const std::uint32_t count : bin) by_size += count;
  for (const PageTally::Window& window : record.pages.windows()) {
    for (const std::uint32_t count : window.pages) by_place += count;
    bytes += window.stored_bytes;
  }
  EXPECT_EQ(by_size, record.summary["pages"]);
  EXPECT_EQ(by_place, record.summary["pages"]);
  const auto& sections = record.summary["bytes"];
  std::uint64_t pages = 0, by_depth = 0;
  for (const char* section : {"cap_pages", "field_pages", "attribute_pages", "mask_pages"})
    pages += sections[section].get<std::uint64_t>();
  for (const LevelRow& level : record.survey.levels) by_depth += level.page_bytes;
  EXPECT_EQ(by_depth, sections["distance_pages"]);
  EXPECT_EQ(bytes, pages + by_depth);
}

}  // namespace
}  // namespace planetree::tools
