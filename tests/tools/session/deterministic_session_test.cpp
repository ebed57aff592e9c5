// Sessions on a simulated disk and clock, as `touch --deterministic` runs them.

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"
#include "tests/tools/trace_file/sample_trace.h"
#include "tools/touch.h"

namespace planetree::tools {
namespace {

using Event = PageAccess::Event;

class DeterministicSession : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    ASSERT_EQ(run({"generate", "statue.ply", "--triangles", "20K", "--quiet"}).status, kDone);
    ASSERT_EQ(
        run({"build", "statue.ply", "-o", "statue.ptree", "--page-size", "8K", "--quiet"}).status,
        kDone);
  }
  Json touch(const std::vector<std::string>& more, const std::string& trace = "") {
    std::vector<std::string> words = {"touch", "statue.ptree", "--deterministic", "--seconds",
                                      "3",     "--json",       "--force"};
    if (!trace.empty()) words.insert(words.end(), {"--trace", trace});
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, kDone) << outcome.errors;
    return Json::parse(outcome.output);
  }
  // The least memory that the model opens with, and room for so many more pages.
  std::string memory(std::uint64_t more_pages) {
    const Outcome refused = run({"touch", "statue.ptree", "--deterministic", "--memory", "1"});
    const std::size_t at = refused.errors.find("at least ");
    EXPECT_NE(at, std::string::npos) << refused.errors;
    const std::uint64_t least = std::stoull(refused.errors.substr(at + 9));
    return std::to_string(least + more_pages * 8192);
  }
};

TEST_F(DeterministicSession, GivesTheSameBytesAgain) {
  for (const std::string motion : {"glide", "scratch", "teleport"}) {
    const std::vector<std::string> options = {"--path", motion, "--memory", memory(6)};
    const Json once = touch(options, "once.trace"), again = touch(options, "again.trace");
    EXPECT_EQ(once, again);
    EXPECT_EQ(file_text("once.trace"), file_text("again.trace"));
    EXPECT_EQ(once["page_trace_dropped"], 0);
    EXPECT_EQ(once["ticks"], 3000);
    EXPECT_FALSE(once.contains("late"));
    touch({"--path", motion, "--memory", memory(6), "--seed", "7"}, "other.trace");
    EXPECT_NE(file_text("once.trace"), file_text("other.trace"));
  }
}

// The records explain each other, also while pages are being read.
TEST_F(DeterministicSession, TraceHoldsAllThatHappened) {
  const Json report = touch({"--path", "scratch", "--memory", memory(4)}, "a.trace");
  const TraceContents trace = read_trace("a.trace");
  ASSERT_EQ(trace.error, "");
  EXPECT_TRUE(trace.header.is_deterministic);
  EXPECT_EQ(trace.header.latency_ns, 85'000u);
  EXPECT_EQ(trace.totals.ticks, 3000u);
  std::set<std::uint32_t> resident;
  std::uint64_t time = 0, degraded = 0, read = 0, evicted = 0, motions = 0;
  for (const PageAccess& access : trace.records) {
    EXPECT_GE(access.time_ns, time);
    time = access.time_ns;
    degraded += access.event == Event::kDegraded && access.query > 0;
    motions += access.event == Event::kMotion;
    if (access.event <= Event::kFetched) {
      EXPECT_EQ(resident.contains(access.page),
                access.event == Event::kHit || access.event == Event::kPrefetched);
    } else if (access.event == Event::kInstalled) {
      ++read;
      EXPECT_TRUE(resident.insert(access.page).second);
      EXPECT_LE(resident.size(), trace.header.frames);
    } else if (access.event == Event::kEvicted || access.event == Event::kEvictedUnused) {
      ++evicted;
      EXPECT_EQ(resident.erase(access.page), 1u);
    }
  }
  EXPECT_EQ(degraded, report["degraded"]);
  EXPECT_EQ(motions, 3000u);
  EXPECT_EQ(read, report["pages_read"]);
  EXPECT_EQ(evicted, report["pages_evicted"]);
  EXPECT_GT(evicted, 20u);
}

// A page that is missed at a tick arrives after the latency, and ticks in between lack it.
TEST_F(DeterministicSession, PagesArriveAfterTheLatency) {
  const auto run_with = [&](const std::string& latency) {
    return touch({"--path", "teleport", "--memory", memory(40), "--latency", latency});
  };
  const Json fast = run_with("1us"), slow = run_with("3.5ms");
  EXPECT_GT(fast["degraded"], 0);
  EXPECT_EQ(fast["refine_ticks_p50"], 1);
  EXPECT_GE(slow["refine_ticks_p50"], 4);
  EXPECT_GT(slow["degraded"], fast["degraded"]);
  EXPECT_EQ(slow["read_latency_us"], 3500.0);
}

TEST_F(DeterministicSession, HasTheFramesOfARealOne) {
  for (const std::uint64_t pages : {0, 5}) {
    const std::string bytes = memory(pages);
    const Outcome real = run(
        {"touch", "statue.ptree", "--seconds", "1", "--rate", "50", "--memory", bytes, "--json"});
    ASSERT_EQ(real.status, kDone) << real.errors;
    const Json simulated = touch({"--memory", bytes});
    EXPECT_EQ(Json::parse(real.output)["frames"], simulated["frames"]);
    EXPECT_EQ(simulated["budget_bytes"], std::stoull(bytes));
  }
}

TEST_F(DeterministicSession, ReportsPrefetching) {
  const Json report = touch({"--path", "glide", "--memory", memory(8)});
  const Json& prefetch = report["prefetch"];
  EXPECT_GT(prefetch["read"], 0);
  EXPECT_GE(prefetch["read"], prefetch["used"]);
  for (const char* key : {"accuracy", "coverage", "timeliness", "waste"}) {
    EXPECT_GE(prefetch[key], 0.0) << key;
    EXPECT_LE(prefetch[key], 1.0) << key;
  }
  const Outcome words = run({"touch", "statue.ptree", "--deterministic", "--seconds", "1"});
  ASSERT_EQ(words.status, kDone);
  const std::vector<std::string> lines = lines_of(words.output);
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[1], "simulated: a page takes 85 us to read; seed 20");
}

TEST_F(DeterministicSession, RefusesWhatNeedsARealDisk) {
  EXPECT_EQ(run({"touch", "statue.ptree", "--deterministic", "--cold"}).status,
            kCommandLineAtFault);
  EXPECT_EQ(run({"touch", "statue.ptree", "--latency", "85us"}).status, kCommandLineAtFault);
  for (const char* latency : {"85", "-1us", "11s", "us", "1 us", "85usx"})
    EXPECT_EQ(run({"touch", "statue.ptree", "--deterministic", "--latency", latency}).status,
              kCommandLineAtFault)
        << latency;
}

}  // namespace
}  // namespace planetree::tools
