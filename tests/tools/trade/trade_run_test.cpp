#include "tools/trade/trade_run.h"

#include <gtest/gtest.h>

#include <vector>

namespace planetree::tools {
namespace {

ClosestPoint answer(double distance, double lower, double upper, Side side = Side::kOutside,
                    Status status = Status::kExact) {
  ClosestPoint answer;
  answer.distance = distance;
  answer.lower = lower;
  answer.upper = upper;
  answer.side = side;
  answer.status = status;
  return answer;
}

TEST(CompareAnswers, MeasuresPromisedAndTrueErrors) {
  const std::vector<ClosestPoint> exact(100, answer(1, 0.99999, 1.00001));
  std::vector<ClosestPoint> answers(100, answer(1.25, 0.75, 1.25));
  answers[7] = answer(3, 0, 4, Side::kUnknown, Status::kDegraded);
  const TradeResult result = compare_answers(answers, exact);
  EXPECT_EQ(result.points, 100u);
  EXPECT_EQ(result.promised.p50, 0.5);
  EXPECT_EQ(result.promised.p99, 4);
  EXPECT_EQ(result.promised.most, 4);
  EXPECT_EQ(result.actual.p50, 0.25);
  EXPECT_EQ(result.actual.most, 2);
  EXPECT_EQ(result.broken, 0u);
  EXPECT_EQ(result.exact, 99u);
  EXPECT_EQ(result.degraded, 1u);
  EXPECT_EQ(result.side_unknown, 1u);
  EXPECT_EQ(result.side_wrong, 0u);
}

// What an engine would answer if one of its bounds were rounded inward.
TEST(CompareAnswers, ReportsIntervalsThatDoNotHoldTheDistance) {
  const std::vector<ClosestPoint> exact(10, answer(1, 1 - 1e-15, 1 + 1e-15));
  std::vector<ClosestPoint> answers = exact;
  answers[2] = answer(1, 1 + 1e-12, 1 + 1e-9);
  answers[5] = answer(1, 1 - 1e-9, 1 - 1e-12);
  EXPECT_EQ(compare_answers(answers, exact).broken, 2u);
}

TEST(CompareAnswers, CountsWrongSidesOnlyWhereBothAreKnown) {
  const std::vector<ClosestPoint> exact{answer(1, 1, 1, Side::kInside),
                                        answer(1, 1, 1, Side::kUnknown),
                                        answer(1, 1, 1, Side::kOutside)};
  const std::vector<ClosestPoint> answers(3, answer(1, 1, 1, Side::kOutside));
  EXPECT_EQ(compare_answers(answers, exact).side_wrong, 1u);
}

TEST(MedianSeconds, RunsTheActionsInTurn) {
  std::vector<int> calls;
  const std::vector<std::function<void()>> actions{[&] { calls.push_back(0); },
                                                   [&] { calls.push_back(1); }};
  const std::vector<double> seconds = median_seconds(actions, 3);
  EXPECT_EQ(calls, (std::vector<int>{0, 1, 0, 1, 0, 1}));
  ASSERT_EQ(seconds.size(), 2u);
  EXPECT_GE(seconds[0], 0);
}

}  // namespace
}  // namespace planetree::tools
