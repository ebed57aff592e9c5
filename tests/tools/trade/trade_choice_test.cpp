#include "tools/trade/trade_choice.h"

#include <gtest/gtest.h>

#include <vector>

namespace planetree::tools {
namespace {

TradeRow row(double max_error, double ratio, double promised, std::size_t broken = 0,
             Wait wait = Wait::kForPages) {
  TradeRow row;
  row.setting.max_error = max_error;
  row.setting.wait = wait;
  for (int workload = 0; workload < 2; ++workload) {
    TradeResult result;
    result.points = 10;
    result.seconds = result.ratio_to_exact = ratio;
    result.promised = {promised / 2, promised, promised};
    result.broken = broken;
    row.results.push_back(result);
  }
  return row;
}

TEST(Choose, TakesTheCheapestSettingThatKeepsTheError) {
  const std::vector<TradeRow> rows{row(0, 1, 1e-12), row(0.01, 0.7, 0.009), row(0.1, 0.4, 0.08),
                                   row(1, 0.5, 0.9)};
  EXPECT_EQ(choose(rows, 1e-6), &rows[0]);
  EXPECT_EQ(choose(rows, 0.01), &rows[1]);
  EXPECT_EQ(choose(rows, 0.5), &rows[2]);
  EXPECT_EQ(choose(rows, 0.095), &rows[1]) << "the option does not promise what was measured";
  EXPECT_EQ(choose(rows, 10), &rows[2]);
  EXPECT_EQ(choose(rows, 1e-13), nullptr);
}

TEST(Choose, TakesNoSettingThatBreaksAnIntervalOrDoesNotWait) {
  const std::vector<TradeRow> rows{row(0, 1, 0), row(0.1, 0.1, 0.1, 1),
                                   row(0.1, 0.1, 0.1, 0, Wait::kNever)};
  EXPECT_EQ(choose(rows, 1), &rows[0]);
}

TEST(Choose, TakesNoLimitOfWorkSinceItPromisesNothing) {
  std::vector<TradeRow> rows{row(0, 1, 0), row(0, 0.1, 0.1)};
  rows[1].setting.max_work = 64;
  EXPECT_EQ(choose(rows, 1), &rows[0]);
}

TEST(Choose, NeedsTheErrorInEveryWorkload) {
  std::vector<TradeRow> rows{row(0, 1, 0), row(0.1, 0.5, 0.1)};
  rows[1].results[1].promised.most = 2;
  EXPECT_EQ(choose(rows, 1), &rows[0]);
}

TEST(TradeRow, IsDominatedByAnotherThatIsNoWorseInAnything) {
  const TradeRow exact = row(0, 1, 0), slow = row(0.1, 1.1, 0.1), fast = row(0.1, 0.9, 0.1);
  EXPECT_TRUE(slow.is_dominated_by(exact));
  EXPECT_TRUE(slow.is_dominated_by(fast));
  EXPECT_FALSE(fast.is_dominated_by(exact));
  EXPECT_FALSE(exact.is_dominated_by(fast));
  EXPECT_FALSE(exact.is_dominated_by(exact));
}

TEST(TradeRow, MeansOfRatiosAreGeometric) {
  TradeRow both = row(0, 1, 0);
  both.results[0].ratio_to_exact = 0.5;
  both.results[1].ratio_to_exact = 2;
  EXPECT_DOUBLE_EQ(both.ratio_to_exact(), 1);
}

}  // namespace
}  // namespace planetree::tools
