// The explorer finds exactly the outcomes that C++20 allows for programs with seq_cst.

#include <gtest/gtest.h>

#include "tests/cache/litmus.h"

namespace planetree::explorer {
namespace {

Explored store_buffering(std::memory_order store, std::memory_order load) {
  return explore_threads({[=](Litmus& all) {
                            all.x.store(1, store);
                            all.found[0] = all.y.load(load);
                          },
                          [=](Litmus& all) {
                            all.y.store(1, store);
                            all.found[1] = all.x.load(load);
                          }});
}

TEST(SeqCstLitmus, ShowsStoreBufferingUnlessAllIsSeqCst) {
  EXPECT_TRUE(store_buffering(kRelaxed, kRelaxed).finds({0, 0}));
  EXPECT_TRUE(store_buffering(kRelease, kAcquire).finds({0, 0}));
  EXPECT_TRUE(store_buffering(kSeqCst, kAcquire).finds({0, 0}));
  EXPECT_TRUE(store_buffering(kRelease, kSeqCst).finds({0, 0}));
  const Explored strong = store_buffering(kSeqCst, kSeqCst);
  EXPECT_FALSE(strong.finds({0, 0}));
  EXPECT_TRUE(strong.finds({0, 1}));
  EXPECT_TRUE(strong.finds({1, 0}));
  EXPECT_TRUE(strong.finds({1, 1}));
}

TEST(SeqCstLitmus, ForbidsStoreBufferingOfThreeThreads) {
  const Explored explored = explore_threads({[](Litmus& all) {
                                               all.x.store(1, kSeqCst);
                                               all.found[0] = all.y.load(kSeqCst);
                                             },
                                             [](Litmus& all) {
                                               all.y.store(1, kSeqCst);
                                               all.found[1] = all.z.load(kSeqCst);
                                             },
                                             [](Litmus& all) {
                                               all.z.store(1, kSeqCst);
                                               all.found[2] = all.x.load(kSeqCst);
                                             }});
  EXPECT_EQ(explored.outcomes.size(), 7u);
  EXPECT_FALSE(explored.finds({0, 0, 0}));
}

Explored independent_reads(std::memory_order store, std::memory_order load) {
  return explore_threads({[=](Litmus& all) { all.x.store(1, store); },
                          [=](Litmus& all) { all.y.store(1, store); },
                          [=](Litmus& all) {
                            all.found[0] = all.x.load(load);
                            all.found[1] = all.y.load(load);
                          },
                          [=](Litmus& all) {
                            all.found[2] = all.y.load(load);
                            all.found[3] = all.x.load(load);
                          }});
}

TEST(SeqCstLitmus, ReadersMayDisagreeOnTheOrderOfStoresUnlessTheyAreSeqCst) {
  EXPECT_TRUE(independent_reads(kRelease, kAcquire).finds({1, 0, 1, 0}));
  EXPECT_TRUE(independent_reads(kSeqCst, kAcquire).finds({1, 0, 1, 0}));
  EXPECT_FALSE(independent_reads(kSeqCst, kSeqCst).finds({1, 0, 1, 0}));
  EXPECT_FALSE(independent_reads(kRelaxed, kSeqCst).finds({1, 0, 1, 0}));
}

Explored overtaken_store(std::memory_order order) {
  return explore_threads({[](Litmus& all) {
                            all.x.store(1, kSeqCst);
                            all.y.store(1, kSeqCst);
                            all.found[1] = all.y.load(kRelaxed);
                          },
                          [=](Litmus& all) {
                            all.y.store(2, order);
                            all.found[0] = all.x.load(kSeqCst);
                          }});
}

TEST(SeqCstLitmus, SeqCstStoresFollowTheModificationOrder) {
  // Where 2 follows 1 in the modification order of y, the seq_cst store to x comes before the store
  // of 2.
  EXPECT_TRUE(overtaken_store(kRelease).finds({0, 2}));
  EXPECT_FALSE(overtaken_store(kSeqCst).finds({0, 2}));
  EXPECT_TRUE(overtaken_store(kSeqCst).finds({0, 1}));
  EXPECT_TRUE(overtaken_store(kSeqCst).finds({1, 2}));
}

TEST(SeqCstLitmus, SeqCstAgreesWithWhatStronglyHappensBefore) {
  // Through z, the first thread's store to x is before the second's load of y. If that load finds
  // 0, it is before the third thread's operations.
  const auto explored = [](std::memory_order store, std::memory_order load) {
    return explore_threads({[=](Litmus& all) {
                              all.x.store(1, kSeqCst);
                              all.z.store(1, store);
                            },
                            [=](Litmus& all) {
                              all.found[0] = all.z.load(load);
                              all.found[1] = all.y.load(kSeqCst);
                            },
                            [](Litmus& all) {
                              all.y.store(1, kSeqCst);
                              all.found[2] = all.x.load(kSeqCst);
                            }});
  };
  EXPECT_FALSE(explored(kRelease, kAcquire).finds({1, 0, 0}));
  EXPECT_TRUE(explored(kRelaxed, kAcquire).finds({1, 0, 0}));
}

TEST(SeqCstLitmus, SeqCstNeedNotAgreeWithAStoreThatIsOnlyAcquired) {
  const auto explored = [](std::memory_order load) {
    return explore_threads({[](Litmus& all) { all.x.store(1, kSeqCst); },
                            [=](Litmus& all) {
                              all.found[0] = all.x.load(load);
                              all.found[1] = all.y.load(kSeqCst);
                            },
                            [](Litmus& all) {
                              all.y.store(1, kSeqCst);
                              all.found[2] = all.x.load(kSeqCst);
                            }});
  };
  EXPECT_TRUE(explored(kAcquire).finds({1, 0, 0}));
  EXPECT_FALSE(explored(kSeqCst).finds({1, 0, 0}));
}

TEST(SeqCstLitmus, SeqCstMayDisagreeWithHappensBeforeThroughWeakerOrders) {
  // P0668R5, "Revising the C++ memory model", first example. Hardware shows this outcome, and C++20
  // allows it where C++17 did not.
  const Explored explored = explore_threads({[](Litmus& all) {
                                               all.x.store(1, kSeqCst);
                                               all.y.store(1, kRelease);
                                             },
                                             [](Litmus& all) {
                                               all.found[0] = all.y.exchange(2, kSeqCst);
                                               all.found[1] = all.y.load(kRelaxed);
                                             },
                                             [](Litmus& all) {
                                               all.y.store(3, kSeqCst);
                                               all.found[2] = all.x.load(kSeqCst);
                                             }});
  EXPECT_TRUE(explored.finds({1, 3, 0}));
}

}  // namespace
}  // namespace planetree::explorer
