#include "tools/tune/memory_search.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace planetree::tools {
namespace {

using Sessions = std::vector<std::vector<FeltTick>>;

/// A session in which each tick is degraded by chance.
std::vector<FeltTick> session_of(double degraded, std::size_t ticks, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<FeltTick> session(ticks);
  for (FeltTick& tick : session) {
    tick.is_degraded = static_cast<double>(random() >> 11) * 0x1p-53 < degraded;
    tick.width = tick.is_degraded ? 1.0F : 0.0F;
  }
  return session;
}

/// A tenth of the ticks is degraded within 10 bytes, a thousandth within 100.
double degraded_with(std::uint64_t bytes) { return 10.0 / static_cast<double>(bytes * bytes); }

MeasureSessions measure_seed(std::uint64_t seed, std::set<std::uint64_t>* measured = nullptr) {
  return [=](std::uint64_t bytes) -> Result<Sessions> {
    if (measured) measured->insert(bytes);
    return Sessions{session_of(degraded_with(bytes), 20'000, seed * 1000 + bytes)};
  };
}

TEST(MemorySearch, FindsMemoryThatFreshSessionsNeed) {
  const TuneGoal goal{TuneGoal::Quantity::kDegraded, 0.01};
  std::set<std::uint64_t> measured;
  MemorySearch search(goal, 4, 1000, 1, measure_seed(1, &measured));
  const auto needed = search.search();
  ASSERT_TRUE(needed && *needed);
  const MemoryNeeded bytes = **needed;
  EXPECT_LE(bytes.low, bytes.recommended);
  EXPECT_LE(bytes.recommended, bytes.high);
  EXPECT_LT(measured.size(), 24u) << "it bisects";
  const auto kept = [&](std::uint64_t with) {
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const auto ticks = session_of(degraded_with(with), 20'000, seed);
      const FeltFigures figures = figures_of(ticks);
      count += static_cast<double>(figures.degraded) < 0.01 * static_cast<double>(ticks.size());
    }
    return count;
  };
  EXPECT_GE(kept(bytes.recommended), 19);
  EXPECT_LE(kept(bytes.recommended * 8 / 10), 5);
}

TEST(MemorySearch, FindsNothingIfAllMemoryIsTooLittle) {
  MemorySearch search({TuneGoal::Quantity::kDegraded, 1e-4}, 4, 50, 1, measure_seed(2));
  const auto needed = search.search();
  ASSERT_TRUE(needed);
  EXPECT_FALSE(*needed);
}

TEST(MemorySearch, TakesTheLeastMemoryIfItSuffices) {
  MemorySearch search({TuneGoal::Quantity::kDegraded, 0.9}, 4, 1000, 1, measure_seed(3));
  const auto needed = search.search();
  ASSERT_TRUE(needed && *needed);
  EXPECT_EQ((*needed)->recommended, 5u) << "and one for a margin";
}

TEST(MemorySearch, DistrustsABudgetThatGreaterOnesContradict) {
  // 10 bytes keep the goal by accident, and 20 do not.
  const auto measure = [](std::uint64_t bytes) -> Result<Sessions> {
    const bool keeps = bytes == 10 || bytes > 20;
    return Sessions{std::vector<FeltTick>(400, {!keeps, keeps ? 0.0F : 1.0F, 0})};
  };
  MemorySearch search({TuneGoal::Quantity::kDegraded, 0.5}, 10, 20 * 2, 1, measure);
  const auto needed = search.search();
  ASSERT_TRUE(needed && *needed);
  EXPECT_EQ((*needed)->recommended, 22u) << "and one for a margin";
}

TEST(MemorySearch, TellsByOneMeasurementWhetherAllMemoryIsEnough) {
  std::set<std::uint64_t> measured;
  MemorySearch enough({TuneGoal::Quantity::kDegraded, 0.01}, 4, 100, 1, measure_seed(1, &measured));
  EXPECT_TRUE(*enough.keeps_goal_with_most());
  EXPECT_EQ(measured, (std::set<std::uint64_t>{100}));
  MemorySearch little({TuneGoal::Quantity::kDegraded, 0.01}, 4, 20, 1, measure_seed(1));
  EXPECT_FALSE(*little.keeps_goal_with_most());
}

TEST(MemorySearch, PassesErrorsOn) {
  const auto measure = [](std::uint64_t) -> Result<Sessions> {
    return make_error(ErrorCode::kReadFailed, Error::kNowhere, Error::kNowhere, "no disk");
  };
  MemorySearch search({TuneGoal::Quantity::kDegraded, 0.5}, 4, 10, 1, measure);
  const auto needed = search.search();
  ASSERT_FALSE(needed);
  EXPECT_EQ(needed.error().code, ErrorCode::kReadFailed);
}

}  // namespace
}  // namespace planetree::tools
