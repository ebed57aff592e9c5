#include "tests/cache/protocol_stress.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/cache/allocation_count.h"

namespace planetree::cache {
namespace {

constexpr StressGoal kShort{.readers = 2, .queries = 50000, .installs = 5000};
// A fetch sleeps while a reader that was preempted inside a section has no processor.
constexpr StressGoal kShortest{.readers = 1, .queries = 20000, .installs = 500};

void expect_right(const StressCount& count, const StressGoal& goal) {
  EXPECT_GE(count.queries, goal.queries);
  EXPECT_GE(count.installs, goal.installs);
  EXPECT_GT(count.found, count.queries);
  EXPECT_EQ(count.wrong, 0u);
}

TEST(ProtocolStress, EveryWordReadIsOfTheRequestedPage) {
  expect_right(stress_protocol(kShort), kShort);
}

TEST(ProtocolStress, EveryWordReadFromAPageCacheIsOfTheRequestedPage) {
  expect_right(stress_page_cache(kShortest), kShortest);
}

class WriterMistakes : public testing::TestWithParam<WriterMistake> {};

TEST_P(WriterMistakes, AreDetectedAsWordsOfAnotherPage) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer would end the program";
  constexpr std::uint64_t kMany = 20'000'000;
  const StressGoal goal{.readers = 2, .queries = kMany, .installs = kMany, .until_wrong = true};
  EXPECT_GT(stress_protocol(goal, GetParam()).wrong, 0u);
}

INSTANTIATE_TEST_SUITE_P(ProtocolStress, WriterMistakes,
                         testing::Values(WriterMistake::kReusesAtOnce,
                                         WriterMistake::kForgetsAReader,
                                         WriterMistake::kNotesTooEarly),
                         [](const testing::TestParamInfo<WriterMistake>& made) {
                           return "Mistake" + std::to_string(static_cast<int>(made.param));
                         });

}  // namespace
}  // namespace planetree::cache
