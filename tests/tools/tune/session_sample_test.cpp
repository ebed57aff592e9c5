#include "tools/tune/session_sample.h"

#include <gtest/gtest.h>

#include <numeric>

namespace planetree::tools {
namespace {

using Quantity = TuneGoal::Quantity;

/// Every hundredth tick begins a run of `run` degraded ticks.
std::vector<FeltTick> runs_of(std::size_t run, std::size_t ticks) {
  std::vector<FeltTick> session(ticks);
  for (std::size_t i = 0; i < ticks; ++i) {
    session[i].is_degraded = i % 100 < run;
    session[i].width = session[i].is_degraded ? static_cast<float>(i % 100 + 1) : 0.0F;
    session[i].misses = i % 100 == 0 ? 5 : 0;
  }
  return session;
}

TEST(SessionSample, HasTheFiguresOfASession) {
  const FeltFigures figures = figures_of(runs_of(3, 2000));
  EXPECT_EQ(figures.ticks, 2000u);
  EXPECT_EQ(figures.degraded, 60u);
  EXPECT_EQ(figures.width_p99, 3) << "one in a hundred is 3 wide";
  EXPECT_EQ(figures.ticks_to_exact_p99, 3u);
  EXPECT_EQ(figures.longest_run, 3u);
  EXPECT_EQ(figures.misses, 100u);
  EXPECT_EQ(figures_of({}).longest_run, 0u);
}

TEST(SessionSample, OfAllBlocksHasTheValuesOfTheSessions) {
  const std::vector<std::vector<FeltTick>> sessions = {runs_of(3, 2000), runs_of(5, 4000)};
  EXPECT_DOUBLE_EQ(SessionBlocks(sessions, Quantity::kDegraded).value(), 260.0 / 6000);
  EXPECT_DOUBLE_EQ(SessionBlocks(sessions, Quantity::kMisses).value(), 0.05);
  EXPECT_EQ(SessionBlocks(sessions, Quantity::kTicksToExact).value(), 5);
  EXPECT_EQ(SessionBlocks({{runs_of(3, 2000)}}, Quantity::kWidth).value(),
            figures_of(runs_of(3, 2000)).width_p99);
  EXPECT_EQ(SessionBlocks({{std::vector<FeltTick>(50)}}, Quantity::kTicksToExact).value(), 0);
}

TEST(SessionSample, DrawsAFirstBlockAndOthersOfOneSession) {
  const auto draws = drawn_sessions(3, 200);
  ASSERT_EQ(draws.size(), 200u);
  std::vector<int> times(3, 0);
  for (const auto& draw : draws) {
    ASSERT_EQ(draw.size(), SessionBlocks::kBlocksPerSession);
    std::size_t first = 0;
    const std::size_t session = draw.front() / SessionBlocks::kBlocksPerSession;
    ++times.at(session);
    for (const std::uint32_t block : draw) {
      EXPECT_EQ(block / SessionBlocks::kBlocksPerSession, session);
      ASSERT_LT(block, 3 * SessionBlocks::kBlocksPerSession);
      first += block % SessionBlocks::kBlocksPerSession == 0;
    }
    EXPECT_EQ(first, 1u);
  }
  for (const int drawn : times) EXPECT_GT(drawn, 40);
}

TEST(SessionSample, SpreadsAroundTheRecordedValue) {
  std::vector<FeltTick> session(4000);
  for (std::size_t i = 0; i < 2000; ++i) session[i].is_degraded = true;
  const SessionBlocks blocks({{session}}, Quantity::kDegraded);
  double mean = 0, least = 1, most = 0;
  const auto draws = drawn_sessions(1, 400);
  for (const auto& draw : draws) {
    const double value = blocks.value_of(draw);
    mean += value / static_cast<double>(draws.size());
    least = std::min(least, value);
    most = std::max(most, value);
  }
  EXPECT_NEAR(mean, 0.5, 0.02);
  EXPECT_LT(least, 0.3);
  EXPECT_GT(most, 0.7);
}

}  // namespace
}  // namespace planetree::tools
