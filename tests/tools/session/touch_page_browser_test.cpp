// The page of a session as a reader sees it, in a browser without a window.

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/html/browser.h"
#include "tests/tools/html/examine_layout.h"
#include "tests/tools/html/html_counts.h"
#include "tools/session/touch_page.h"
#include "tools/session/touch_timeline.h"

namespace planetree::tools {
namespace {

TouchArguments sample_arguments(bool is_deterministic) {
  TouchArguments arguments;
  arguments.file = "</script><b>a\xFF.ptree";
  arguments.is_deterministic = is_deterministic;
  arguments.radius = is_deterministic ? 2.5 : 0;
  return arguments;
}

/// Some ticks are degraded, one in a thousand is late, and one has no bound.
TouchRecord sample_session(std::size_t ticks, bool is_timed) {
  TouchRecord record;
  for (std::size_t i = 0; i < ticks; ++i) {
    Tick tick;
    if (is_timed) {
      tick.latency_ns = static_cast<std::uint32_t>(20000 + 977 * (i % 89));
      if (i % 1000 == 500) tick.latency_ns = 3'000'000;
      tick.query_ns = tick.latency_ns / 3;
      record.floor_ns.push_back(tick.latency_ns / 2);
    }
    tick.side = Side::kOutside;
    if (i % 400 < 7) {
      tick.status = Status::kDegraded;
      tick.width = i % 3 == 0 ? 1e-14F : 0.25F * static_cast<float>(1 + i % 7);
    }
    record.ticks.push_back(tick);
  }
  if (ticks > 10) record.ticks[3].width = std::numeric_limits<float>::infinity();
  return record;
}

Stats sample_stats() {
  Stats stats{};
  stats.budget_bytes = TouchArguments().memory_bytes;
  stats.arena_bytes = 3 << 20;
  stats.pages_read = 1234;
  return stats;
}

class TouchPageInBrowser : public testing::Test {
 protected:
  void SetUp() override {
    if (!Browser::is_here()) GTEST_SKIP() << Browser::kMissing;
  }
  nlohmann::json examined(std::size_t ticks, bool is_deterministic, const std::string& examination,
                          const BrowserWindow& window) {
    const TouchArguments arguments = sample_arguments(is_deterministic);
    PrefetchFigures prefetch;
    prefetch.read = 8;
    prefetch.used = 6;
    const std::string html =
        touch_page(arguments, sample_session(ticks, !is_deterministic), sample_stats(),
                   is_deterministic ? nullptr : &prefetch, "planetree");
    BrowserVisit visit = Browser::visit(html, examination, window, folder_ / ".");
    for (const std::string& complaint : visit.complaints) ADD_FAILURE() << complaint;
    for (const std::string& request : visit.requests) ADD_FAILURE() << "asks for " << request;
    return visit.report;
  }

  storage::TemporaryDirectory folder_;
};

TEST_F(TouchPageInBrowser, FitsWindowsOfAnyWidthInBothThemes) {
  for (const std::size_t ticks : {std::size_t{1}, std::size_t{1000}, std::size_t{123456}})
    for (const bool is_deterministic : {false, true})
      for (const int width : {390, 1440}) {
        const bool is_dark = is_deterministic == (width == 390);
        const auto report = examined(ticks, is_deterministic, kExamineLayout, {width, is_dark});
        ASSERT_TRUE(report.is_object());
        EXPECT_LE(report["scrollWidth"], width) << "the page scrolls sideways";
        EXPECT_EQ(report["isDark"], is_dark);
        EXPECT_EQ(report["covered"], nlohmann::json::array()) << width << " " << ticks;
        EXPECT_EQ(report["cut"], nlohmann::json::array()) << width << " " << ticks;
        EXPECT_EQ(report["faint"], nlohmann::json::array()) << is_dark;
      }
}

constexpr const char* kExamineParts = R"js(
  const keys = [...document.querySelectorAll('svg.plot .point')].map((p) => p.dataset.key);
  const rows = new Set([...document.querySelectorAll('tr[data-key]')].map((r) => r.dataset.key));
  const count = (id) => document.querySelectorAll('#' + id + ' .point').length;
  return {
    plots: [...document.querySelectorAll('svg.plot')].map((svg) => svg.id),
    headings: [...document.querySelectorAll('h2')].map((heading) => heading.innerText),
    lost: keys.filter((key) => !rows.has(key)), times: count('times'),
    latency: count('latency-time'), late: document.querySelectorAll('#latency-time .c1').length,
    unbounded: document.querySelectorAll('#width-time .c1').length,
    title: document.querySelector('h1').innerText, bold: document.querySelectorAll('b').length,
  })js";

TEST_F(TouchPageInBrowser, DrawsTimesAndMarksLateWindows) {
  const auto report = examined(9600, false, kExamineParts, {1440, false});
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["plots"],
            (nlohmann::json{"times", "latency-time", "degraded-time", "width-time"}));
  EXPECT_EQ(report["headings"], (nlohmann::json{"Latency", "Over time", "Answers", "Memory",
                                                "Prefetch", "Machine", "Command"}));
  EXPECT_EQ(report["lost"], nlohmann::json::array());
  EXPECT_EQ(report["times"], 3 * 13) << "min, 50 to 99.975 %, max";
  EXPECT_EQ(report["latency"], 96);
  EXPECT_EQ(report["late"], 10);
  EXPECT_EQ(report["unbounded"], 1);
  EXPECT_EQ(report["title"], "</script><b>a\xEF\xBF\xBD.ptree");
  EXPECT_EQ(report["bold"], 0);
}

TEST_F(TouchPageInBrowser, TellsNothingOfTheMachineIfItIsSimulated) {
  const auto report = examined(9600, true, kExamineParts, {390, false});
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["plots"], (nlohmann::json{"degraded-time", "width-time"}));
  EXPECT_EQ(report["headings"], (nlohmann::json{"Over time", "Answers", "Memory", "Command"}));
  EXPECT_EQ(report["lost"], nlohmann::json::array());
}

TEST_F(TouchPageInBrowser, ShowsFiguresByTheKeyboard) {
  const auto report = examined(9600, false, R"js(
    const svg = document.querySelector('#latency-time');
    const tip = svg.parentElement.querySelector('.tip');
    svg.focus();
    svg.dispatchEvent(new KeyboardEvent('keydown', {key: 'Escape'}));
    const titles = [];
    for (let i = 0; i < 96; ++i) {
      svg.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight'}));
      titles.push(tip.innerText);
    }
    return titles;)js",
                               {390, true});
  const std::set<std::string> titles = report;
  EXPECT_EQ(titles.size(), 96u) << "each window once";
  EXPECT_NE(titles.begin()->find("median (latency, us)"), std::string::npos) << *titles.begin();
}

TEST(TouchTimeline, CountsEachTickOnce) {
  const TouchRecord record = sample_session(12345, true);
  const TouchTimeline timeline(record.ticks, 1'000'000);
  EXPECT_LE(timeline.windows().size(), TouchTimeline::kMaxWindows);
  std::size_t ticks = 0, late = 0, degraded = 0;
  for (const TouchTimeline::Window& window : timeline.windows()) {
    EXPECT_EQ(window.first, ticks);
    ticks += window.ticks;
    late += window.late;
    degraded += window.degraded;
    EXPECT_LE(window.median_latency_us, window.max_latency_us);
  }
  EXPECT_EQ(ticks, 12345u);
  EXPECT_EQ(late, 12u);
  EXPECT_EQ(degraded, 31u * 7);
  EXPECT_DOUBLE_EQ(timeline.seconds(2000), 2);
}

TEST(TouchCommand, LeavesOutDefaults) {
  TouchArguments arguments;
  arguments.file = "a b.ptree";
  arguments.page.html = "out.html";
  EXPECT_EQ(touch_command(arguments), "planetree touch 'a b.ptree' --html out.html --force");
  arguments.seconds = 2;
  arguments.motion = TouchMotion::kScratch;
  arguments.radius = 0.5;
  arguments.is_deterministic = arguments.latency_is_given = true;
  arguments.latency_ns = 1500;
  arguments.trace = "t.trace";
  EXPECT_EQ(touch_command(arguments),
            "planetree touch 'a b.ptree' --seconds 2 --path scratch --tool sphere --radius 0.5 "
            "--deterministic --latency 1500ns --trace t.trace --html out.html --force");
}

}  // namespace
}  // namespace planetree::tools
