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
#include "tools/session/touch_instances.h"
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

TouchOutcome sample_outcome(std::size_t ticks, bool is_timed) {
  TouchOutcome outcome;
  outcome.record = sample_session(ticks, is_timed);
  outcome.stats = sample_stats();
  if (!is_timed) return outcome;
  outcome.prefetch.emplace();
  outcome.prefetch->read = 8;
  outcome.prefetch->used = 6;
  return outcome;
}

/// A session in a scene of so many instances. The last one answers a hundred ticks, and each of the
/// others two, as far as ticks go.
TouchOutcome sample_scene_outcome(std::size_t ticks, std::size_t instances) {
  TouchOutcome outcome = sample_outcome(ticks, true);
  outcome.prefetch.reset();
  for (std::size_t i = 0; i < instances; ++i)
    outcome.instances.push_back({InstanceId{10 + i}, i == 0 ? "</td>left" : "", "statue", i == 1});
  for (std::size_t i = 0; i < ticks; ++i)
    outcome.record.ticks[i].instance =
        InstanceId{10 + (i < 100 ? instances - 1 : (i - 100) / 2)};  // some are of none
  return outcome;
}

class TouchPageInBrowser : public testing::Test {
 protected:
  void SetUp() override {
    if (!Browser::is_here()) GTEST_SKIP() << Browser::kMissing;
  }
  nlohmann::json examined(std::size_t ticks, bool is_deterministic, const std::string& examination,
                          const BrowserWindow& window) {
    const TouchArguments arguments = sample_arguments(is_deterministic);
    const std::string html =
        touch_page(arguments, sample_outcome(ticks, !is_deterministic), "planetree");
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

TEST_F(TouchPageInBrowser, ListsInstancesOfAScene) {
  TouchArguments arguments = sample_arguments(false);
  arguments.is_scene = true;
  const std::string html = touch_page(arguments, sample_scene_outcome(1000, 150), "planetree");
  BrowserVisit visit = Browser::visit(html, R"js(
    const table = [...document.querySelectorAll('table')].find((each) =>
      each.innerText.includes('statue'));
    return {rows: table.querySelectorAll('tbody tr').length,
            first: table.querySelector('tbody tr').innerText,
            second: table.querySelectorAll('tbody tr')[1].innerText,
            text: document.body.innerText, width: document.documentElement.scrollWidth};)js",
                                      {390, true}, folder_ / ".");
  for (const std::string& complaint : visit.complaints) ADD_FAILURE() << complaint;
  ASSERT_TRUE(visit.report.is_object());
  EXPECT_EQ(visit.report["rows"], 100);
  EXPECT_NE(visit.report["first"].get<std::string>().find("149"), std::string::npos);
  EXPECT_NE(visit.report["second"].get<std::string>().find("</td>left"), std::string::npos);
  const std::string text = visit.report["text"];
  EXPECT_NE(text.find("1 of 150 instances move"), std::string::npos);
  EXPECT_NE(text.find("600 ticks had no instance"), std::string::npos);
  EXPECT_EQ(text.find("pages read ahead"), std::string::npos) << "scenes do not";
  EXPECT_LE(visit.report["width"], 390);
}

TEST(InstanceTally, CountsEachTickOnce) {
  const TouchOutcome outcome = sample_scene_outcome(1000, 150);
  const InstanceTally tally(outcome);
  EXPECT_EQ(tally.ticks()[0], 2u);
  EXPECT_EQ(tally.ticks()[149], 102u);
  EXPECT_EQ(tally.none(), 600u);
  EXPECT_EQ(tally.leading(2), (std::vector<std::size_t>{149, 0}));
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

TEST(TouchCommand, NamesTheMemoryOfAScene) {
  TouchArguments arguments;
  arguments.file = "table.json";
  arguments.is_scene = true;
  EXPECT_EQ(touch_command(arguments),
            "planetree touch --scene table.json --memory 268435456 --force");
}

}  // namespace
}  // namespace planetree::tools
