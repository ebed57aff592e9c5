// Tens of thousands of random queries; `./dev check-random` makes a million.

#include "tests/oracle/random_queries.h"

#include <gtest/gtest.h>

namespace planetree::oracle {
namespace {

constexpr std::size_t kQueriesPerModel = 2500;
constexpr std::size_t kModelsPerTest = 4;

// Split so that no test takes long with a sanitizer.
class RandomQueries : public testing::TestWithParam<std::size_t> {};

TEST_P(RandomQueries, AreAnsweredRight) {
  QueryTally tally;
  for (std::size_t i = 0; i < kModelsPerTest; ++i)
    tally += query_at_random(GetParam() * kModelsPerTest + i, kQueriesPerModel);
  EXPECT_EQ(tally.queries, kModelsPerTest * kQueriesPerModel);
  EXPECT_EQ(tally.not_finite, 0u);
  EXPECT_EQ(tally.interval, 0u);
  EXPECT_EQ(tally.side, 0u);
  EXPECT_EQ(tally.normal, 0u);
  EXPECT_EQ(tally.limited, 0u);
  EXPECT_GT(tally.limited_exact, 0u);
  EXPECT_EQ(tally.first_miss, "");
}

INSTANTIATE_TEST_SUITE_P(Models, RandomQueries,
                         testing::Range(std::size_t{0}, kQueriedModels / kModelsPerTest));

}  // namespace
}  // namespace planetree::oracle
