#include "tools/touch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "planetree/probe.h"
#include "tests/tools/cli/command_fixture.h"
#include "tests/tools/trace_file/sample_trace.h"
#include "tools/session/session_path.h"

namespace planetree::tools {
namespace {

double distance_between(const Vec3& a, const Vec3& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

class SessionTest : public Command {
 protected:
  std::vector<Vec3> path(TouchMotion motion, std::size_t ticks = 3000) {
    const auto model = Model::open("tree.ptree");
    EXPECT_TRUE(model);
    auto probe = Probe::create(*model);
    EXPECT_TRUE(probe);
    const ModelInfo& info = model->info();
    diagonal_ = distance_between(info.box_lower, info.box_upper);
    return touch_path(*model, *probe, motion, ticks);
  }
  static double longest_step(const std::vector<Vec3>& path) {
    double longest = 0;
    for (std::size_t i = 1; i < path.size(); ++i)
      longest = std::max(longest, distance_between(path[i - 1], path[i]));
    return longest;
  }

  static std::string read_text(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  double diagonal_ = 0;
};

TEST_F(SessionTest, StepsOfGlideAndScratchHaveTheStatedLength) {
  const double gliding = longest_step(path(TouchMotion::kGlide));
  EXPECT_NEAR(gliding, 2e-4 * diagonal_, 1e-9 * diagonal_);
  const double scratching = longest_step(path(TouchMotion::kScratch));
  EXPECT_NEAR(scratching, 1e-3 * diagonal_, 1e-9 * diagonal_);
}

TEST_F(SessionTest, ScratchStaysOnTheSurface) {
  const std::vector<Vec3> tips = path(TouchMotion::kScratch);
  const auto model = Model::open("tree.ptree");
  auto probe = Probe::create(*model);
  for (const Vec3& tip : tips) ASSERT_LT(probe->closest_point(tip).distance, 0.01 * diagonal_);
  EXPECT_GT(distance_between(tips.front(), tips.back()), 0.01 * diagonal_);
}

TEST_F(SessionTest, TeleportsEveryHundredTicks) {
  const std::vector<Vec3> tips = path(TouchMotion::kTeleport);
  std::size_t jumps = 0;
  for (std::size_t i = 1; i < tips.size(); ++i) {
    const bool jumped = distance_between(tips[i - 1], tips[i]) > 0;
    jumps += jumped;
    EXPECT_TRUE(!jumped || i % 100 == 0);
  }
  EXPECT_GT(jumps, 20u);
}

TEST_F(SessionTest, PathIsRepeatable) {
  const std::vector<Vec3> once = path(TouchMotion::kGlide), again = path(TouchMotion::kGlide);
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i)
    ASSERT_EQ(distance_between(once[i], again[i]), 0) << i;
}

TEST_F(SessionTest, ReportsASession) {
  for (const std::string motion : {"glide", "scratch", "teleport"}) {
    const Outcome outcome = run({"touch", "tree.ptree", "--seconds", "1", "--rate", "500", "--path",
                                 motion, "--cold", "--json"});
    ASSERT_EQ(outcome.status, kDone) << outcome.errors;
    const Json report = Json::parse(outcome.output);
    EXPECT_EQ(report["ticks"], 500);
    EXPECT_EQ(report["path"], motion);
    EXPECT_LE(report["degraded"], 500);
    EXPECT_LE(report["late"], 500);
    EXPECT_LE(report["latency_us"]["p50"], report["latency_us"]["max"]);
    EXPECT_GT(report["floor_us"]["p50"], 0);
    EXPECT_LE(report["query_us"]["p99"], report["query_us"]["p999"]);
    EXPECT_LE(report["held_bytes"], report["budget_bytes"]);
    EXPECT_GE(report["pages_read"], 1);
    EXPECT_LE(report["refine_ticks_p50"], report["refine_ticks_p99"]);
  }
}

TEST_F(SessionTest, ReportsASessionAsText) {
  const Outcome outcome = run({"touch", "tree.ptree", "--seconds", "1", "--rate", "100"});
  ASSERT_EQ(outcome.status, kDone) << outcome.errors;
  const std::vector<std::string> lines = lines_of(outcome.output);
  ASSERT_EQ(lines.size(), 8u);
  EXPECT_EQ(lines[0].find("tree.ptree: glide, 100 ticks at 100 Hz"), 0u);
  EXPECT_EQ(lines[3].find("latency "), 0u);
}

TEST_F(SessionTest, WritesEveryTickOnRequest) {
  const std::vector<std::string> session = {"touch",  "tree.ptree", "--seconds", "1",
                                            "--rate", "200",        "--ticks",   "ticks.csv"};
  ASSERT_EQ(run(session).status, kDone);
  const std::vector<std::string> rows = lines_of(read_text("ticks.csv"));
  ASSERT_EQ(rows.size(), 201u);
  EXPECT_EQ(rows[0], "tick,x,y,z,latency_us,query_us,width,side,status");
  EXPECT_EQ(rows[200].find("199,"), 0u);
  EXPECT_EQ(std::count(rows[200].begin(), rows[200].end(), ','), 8);
  const Outcome again = run(session);
  EXPECT_EQ(again.status, kCommandLineAtFault);
  EXPECT_EQ(again.output, "");
}

TEST_F(SessionTest, WritesThePageTraceOnRequest) {
  const Outcome outcome = run({"touch", "tree.ptree", "--seconds", "1", "--rate", "200", "--trace",
                               "pages.trace", "--policy", "lru", "--json"});
  ASSERT_EQ(outcome.status, kDone) << outcome.errors;
  const Json report = Json::parse(outcome.output);
  EXPECT_EQ(report["page_trace_dropped"], 0);
  const TraceContents trace = read_trace("pages.trace");
  ASSERT_EQ(trace.error, "");
  EXPECT_EQ(trace.header.model, "tree.ptree");
  EXPECT_EQ(trace.header.rate_hz, 200u);
  EXPECT_EQ(trace.header.policy, EvictionPolicy::kLru);
  EXPECT_EQ(trace.header.frames, report["frames"]);
  EXPECT_EQ(trace.header.memory_bytes, report["budget_bytes"]);
  EXPECT_FALSE(trace.header.is_deterministic);
  EXPECT_EQ(trace.totals.ticks, 200u);
  EXPECT_EQ(trace.totals.lost, 0u);
  std::uint64_t motions = 0, last = 0, read = 0;
  for (const PageAccess& access : trace.records) {
    EXPECT_LT(access.page, entries_.size());
    read += access.event == PageAccess::Event::kInstalled;
    if (access.event != PageAccess::Event::kMotion) continue;
    // The first query precedes the ticks.
    EXPECT_EQ(access.query, ++last);
    ++motions;
  }
  EXPECT_EQ(motions, 200u);
  EXPECT_EQ(read, report["pages_read"]);
  EXPECT_EQ(run({"touch", "tree.ptree", "--trace", "pages.trace"}).status, kCommandLineAtFault);
}

TEST_F(SessionTest, RefusesASessionWithoutTicks) {
  const Outcome outcome = run({"touch", "tree.ptree", "--seconds", "0"});
  EXPECT_EQ(outcome.status, kCommandLineAtFault);
  EXPECT_EQ(outcome.errors,
            "planetree: touch: the session has no ticks; give --seconds and --rate of 1 or more; "
            "see planetree touch --help\n");
}

TEST_F(SessionTest, ReportsPagesThatCannotBeRead) {
  flip("tree.ptree", entries_.back().offset);
  const Outcome outcome =
      run({"touch", "tree.ptree", "--seconds", "1", "--rate", "500", "--path", "teleport"});
  EXPECT_EQ(outcome.status, kDataAtFault);
}

}  // namespace
}  // namespace planetree::tools
