// The explorer finds exactly the outcomes that C++20 allows for small programs without seq_cst.

#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <vector>

#include "tests/cache/litmus.h"

namespace planetree::explorer {
namespace {

Explored message_passing(std::memory_order store, std::memory_order load) {
  return explore_threads({[=](Litmus& all) {
                            all.x.store(1, kRelaxed);
                            all.y.store(1, store);
                          },
                          [=](Litmus& all) {
                            all.found[0] = all.y.load(load);
                            all.found[1] = all.x.load(kRelaxed);
                          }});
}

TEST(Litmus, MessagePassingNeedsReleaseAndAcquire) {
  EXPECT_TRUE(message_passing(kRelaxed, kRelaxed).finds({1, 0}));
  EXPECT_TRUE(message_passing(kRelease, kRelaxed).finds({1, 0}));
  EXPECT_TRUE(message_passing(kRelaxed, kAcquire).finds({1, 0}));
  const Explored right = message_passing(kRelease, kAcquire);
  EXPECT_FALSE(right.finds({1, 0}));
  EXPECT_TRUE(right.finds({0, 0}));
  EXPECT_TRUE(right.finds({0, 1}));
  EXPECT_TRUE(right.finds({1, 1}));
}

TEST(Litmus, LoadsNeverReturnOlderStoresThanEarlierLoads) {
  const Explored explored = explore_threads({[](Litmus& all) {
                                               all.x.store(1, kRelaxed);
                                               all.x.store(2, kRelaxed);
                                             },
                                             [](Litmus& all) {
                                               all.found[0] = all.x.load(kRelaxed);
                                               all.found[1] = all.x.load(kRelaxed);
                                             }});
  std::set<std::pair<int, int>> seen;
  for (const std::vector<int>& found : explored.outcomes) seen.insert({found[0], found[1]});
  const std::set<std::pair<int, int>> rising{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};
  EXPECT_EQ(seen, rising);
}

TEST(Litmus, LoadsNothingOlderThanALoadThatHappensBefore) {
  // The third thread learns of the second's load of x through z, and so of the store that it read.
  const Explored explored = explore_threads({[](Litmus& all) { all.x.store(1, kRelaxed); },
                                             [](Litmus& all) {
                                               all.found[0] = all.x.load(kRelaxed);
                                               all.z.store(1, kRelease);
                                             },
                                             [](Litmus& all) {
                                               all.found[1] = all.z.load(kAcquire);
                                               all.found[2] = all.x.load(kRelaxed);
                                             }});
  EXPECT_FALSE(explored.finds({1, 1, 0}));
  EXPECT_TRUE(explored.finds({1, 0, 0}));
  EXPECT_TRUE(explored.finds({0, 1, 1}));
}

Explored passing_on(std::memory_order store) {
  return explore_threads({[=](Litmus& all) {
                            all.x.store(1, kRelaxed);
                            all.y.store(1, store);
                          },
                          [](Litmus& all) { all.found[0] = all.y.exchange(2, kRelaxed); },
                          [](Litmus& all) {
                            all.found[1] = all.y.load(kAcquire);
                            all.found[2] = all.x.load(kRelaxed);
                          }});
}

TEST(Litmus, ExchangeContinuesAReleaseSequence) {
  EXPECT_FALSE(passing_on(kRelease).finds({1, 2, 0}));
  EXPECT_TRUE(passing_on(kRelease).finds({0, 2, 0}));
  EXPECT_TRUE(passing_on(kRelease).finds({1, 2, 1}));
  EXPECT_TRUE(passing_on(kRelaxed).finds({1, 2, 0}));
}

TEST(Litmus, ExchangesAcquire) {
  const auto explored = [](std::memory_order order) {
    return explore_threads({[](Litmus& all) {
                              all.x.store(1, kRelaxed);
                              all.y.store(1, kRelease);
                            },
                            [=](Litmus& all) {
                              all.found[0] = all.y.exchange(2, order);
                              all.found[1] = all.x.load(kRelaxed);
                            }});
  };
  EXPECT_TRUE(explored(kRelaxed).finds({1, 0}));
  EXPECT_FALSE(explored(kAcquire).finds({1, 0}));
  EXPECT_TRUE(explored(kAcquire).finds({1, 1}));
}

}  // namespace
}  // namespace planetree::explorer
