#include "tools/simulation/simulated_session.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/tools/cli/command_fixture.h"
#include "tools/session/session_path.h"

namespace planetree::tools {
namespace {

class SimulatedSessions : public Command {
 protected:
  std::vector<Vec3> path() {
    const auto model = Model::open("tree.ptree");
    EXPECT_TRUE(model);
    auto probe = Probe::create(*model);
    EXPECT_TRUE(probe);
    return touch_path(*model, *probe, TouchMotion::kTeleport, 1000);
  }
  static SimulatedRecord simulate(SimulationOptions options, const std::vector<Vec3>& path,
                                  std::vector<PageAccess>& records) {
    options.file = "tree.ptree";
    const auto session = SimulatedSession::open(options);
    EXPECT_TRUE(session);
    records.clear();
    return (*session)->run(path, [&](std::span<const PageAccess> accesses) {
      records.insert(records.end(), accesses.begin(), accesses.end());
    });
  }
};

TEST_F(SimulatedSessions, QueriesThatWaitLackNoPageAndReadTheirOwn) {
  const std::vector<Vec3> tips = path();
  SimulationOptions options;
  options.wait = Wait::kForPages;
  std::vector<PageAccess> records;
  const SimulatedRecord record = simulate(options, tips, records);
  ASSERT_EQ(record.ticks.size(), tips.size());
  // Points of an open mesh may have no side.
  EXPECT_EQ(record.stats.degraded_answers, record.stats.degraded_without_misses);
  std::uint64_t read = 0, fetched = 0;
  for (const PageAccess& access : records) {
    EXPECT_TRUE(access.event == PageAccess::Event::kMotion || access.waits);
    EXPECT_EQ(access.probe, 0u);
    read += access.event == PageAccess::Event::kInstalled;
    fetched += access.event == PageAccess::Event::kFetched;
  }
  EXPECT_EQ(read, record.stats.pages_read);
  EXPECT_EQ(read, fetched + 1);  // and the root, which open pins
  EXPECT_EQ(record.stats.fetch_requests, 0u);
}

TEST_F(SimulatedSessions, PrefetchNothingWithoutMotion) {
  const std::vector<Vec3> tips = path();
  SimulationOptions options;
  options.tells_motion = false;
  std::vector<PageAccess> records;
  const SimulatedRecord record = simulate(options, tips, records);
  EXPECT_EQ(record.prefetch.read, 0u);
  EXPECT_EQ(record.stats.pages_prefetched, 0u);
  EXPECT_GT(record.stats.fetch_requests_served, 0u);
  for (const PageAccess& access : records) {
    EXPECT_NE(access.event, PageAccess::Event::kMotion);
    EXPECT_NE(access.query_kind, PageAccess::Query::kPrefetch);
  }
}

TEST_F(SimulatedSessions, SayWhyTheyCannotBegin) {
  SimulationOptions options;
  options.file = "none.ptree";
  EXPECT_EQ(SimulatedSession::open(options).error().code, ErrorCode::kNotFound);
  options.file = "tree.ptree";
  options.memory_bytes = 1;
  EXPECT_EQ(SimulatedSession::open(options).error().code, ErrorCode::kNoMemory);
}

}  // namespace
}  // namespace planetree::tools
