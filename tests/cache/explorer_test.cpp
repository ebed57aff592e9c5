// The explorer, on programs whose possible outcomes are known. Each runs every
// schedule; outcomes are collected, so that what is possible must be seen and
// what is not must not.

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include "tests/cache/explorer/atomic.h"
#include "tests/cache/explorer/explore.h"

namespace planetree::explorer {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;
constexpr auto kAcquire = std::memory_order_acquire;
constexpr auto kRelease = std::memory_order_release;
constexpr auto kSeqCst = std::memory_order_seq_cst;

/// Three atomics x, y, z, two plain variables, a mutex; and what threads found.
struct Litmus {
  Atomic<int> x{0}, y{0}, z{0};
  Plain<int> a{0}, b{0};
  Mutex mutex;
  std::vector<int> found = std::vector<int>(4, -1);
};

using Body = std::function<void(Litmus&)>;
using Outcomes = std::set<std::vector<int>>;

class LitmusProgram final : public Program {
 public:
  LitmusProgram(const std::vector<Body>& bodies, Outcomes& outcomes)
      : bodies_(bodies), outcomes_(outcomes) {}
  std::uint32_t thread_count() const noexcept override {
    return static_cast<std::uint32_t>(bodies_.size());
  }
  void run(std::uint32_t thread) override { bodies_[thread](litmus_); }
  void finish() override { outcomes_.insert(litmus_.found); }

 private:
  const std::vector<Body>& bodies_;
  Outcomes& outcomes_;
  Litmus litmus_;
};

struct Explored {
  Outcomes outcomes;
  Report report;
  bool finds(const std::vector<int>& found) const {
    std::vector<int> padded = found;
    padded.resize(4, -1);
    return outcomes.contains(padded);
  }
};

constexpr std::uint32_t kNoLimit = 1000;

Explored explore_threads(const std::vector<Body>& bodies) {
  Explored explored;
  explored.report = explore_all(
      [&] { return std::make_unique<LitmusProgram>(bodies, explored.outcomes); }, kNoLimit);
  return explored;
}

TEST(Explorer, RunsEverySchedule) {
  // Two threads of two steps that cannot be told apart by what they load: the
  // ways to choose the first thread's steps among four.
  const auto two_steps = [](Litmus& all) {
    all.z.exchange(1, kRelaxed);
    all.z.exchange(1, kRelaxed);
  };
  EXPECT_EQ(explore_threads({two_steps, two_steps}).report.runs, 6u);
}

TEST(Explorer, StopsThreadsNoMoreOftenThanTold) {
  const auto two_steps = [](Litmus& all) {
    all.z.exchange(1, kRelaxed);
    all.z.exchange(1, kRelaxed);
  };
  const std::vector<Body> bodies{two_steps, two_steps};
  Outcomes outcomes;
  const auto make = [&] { return std::make_unique<LitmusProgram>(bodies, outcomes); };
  EXPECT_EQ(explore_all(make, 0).runs, 2u);
  EXPECT_EQ(explore_all(make, 1).runs, 4u);
}

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

TEST(Explorer, ShowsStoreBufferingUnlessAllIsSeqCst) {
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

TEST(Explorer, PassesMessagesByReleaseAndAcquireOnly) {
  EXPECT_TRUE(message_passing(kRelaxed, kRelaxed).finds({1, 0}));
  EXPECT_TRUE(message_passing(kRelease, kRelaxed).finds({1, 0}));
  EXPECT_TRUE(message_passing(kRelaxed, kAcquire).finds({1, 0}));
  const Explored right = message_passing(kRelease, kAcquire);
  EXPECT_FALSE(right.finds({1, 0}));
  EXPECT_TRUE(right.finds({0, 0}));
  EXPECT_TRUE(right.finds({0, 1}));
  EXPECT_TRUE(right.finds({1, 1}));
}

Report plain_message(std::memory_order store, std::memory_order load) {
  return explore_threads({[=](Litmus& all) {
                            all.a.write(1);
                            all.y.store(1, store);
                          },
                          [=](Litmus& all) {
                            if (all.y.load(load) == 1 && all.a.read() != 1) {
                              Execution::current().fail("an old value");
                            }
                          }})
      .report;
}

TEST(Explorer, ReportsDataRaces) {
  EXPECT_NE(plain_message(kRelaxed, kAcquire).failure.find("data race"), std::string::npos);
  EXPECT_NE(plain_message(kRelease, kRelaxed).failure.find("data race"), std::string::npos);
  EXPECT_EQ(plain_message(kRelease, kAcquire).failure, "");
}

TEST(Explorer, ReportsAWriteAfterAReadAsARace) {
  // The loads say that the reader is done; without acquire or release this
  // does not make the read happen before the write.
  const auto report = [](std::memory_order store, std::memory_order load) {
    return explore_threads({[=](Litmus& all) {
                              all.a.read();
                              all.y.store(1, store);
                            },
                            [=](Litmus& all) {
                              if (all.y.load(load) == 1) all.a.write(1);
                            }})
        .report.failure;
  };
  EXPECT_NE(report(kRelaxed, kAcquire).find("a write after"), std::string::npos);
  EXPECT_NE(report(kRelease, kRelaxed).find("a write after"), std::string::npos);
  EXPECT_EQ(report(kRelease, kAcquire), "");
}

TEST(Explorer, ReadsDoNotRaceWithReads) {
  const auto read = [](Litmus& all) { all.a.read(); };
  EXPECT_EQ(explore_threads({read, read, read}).report.failure, "");
}

TEST(Explorer, NeverLoadsOlderStoresThanBefore) {
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

TEST(Explorer, LoadsNothingOlderThanWhatHappenedBefore) {
  // Another thread's load is known through z, and its store through z too.
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

TEST(Explorer, ReadersMayDisagreeOnTheOrderOfStoresUnlessAllIsSeqCst) {
  EXPECT_TRUE(independent_reads(kRelease, kAcquire).finds({1, 0, 1, 0}));
  EXPECT_TRUE(independent_reads(kSeqCst, kAcquire).finds({1, 0, 1, 0}));
  EXPECT_FALSE(independent_reads(kSeqCst, kSeqCst).finds({1, 0, 1, 0}));
}

TEST(Explorer, LetsSeqCstDisagreeWithHappensBeforeThroughOtherOrders) {
  // P0668R5, "Revising the C++ memory model", the first example: hardware does
  // it, and C++20 allows it where C++17 did not.
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

TEST(Explorer, ExchangesPassMessagesOn) {
  const auto found_old = [](std::memory_order store) {
    const Explored explored = explore_threads({[=](Litmus& all) {
                                                 all.x.store(1, kRelaxed);
                                                 all.y.store(1, store);
                                               },
                                               [](Litmus& all) { all.y.exchange(2, kRelaxed); },
                                               [](Litmus& all) {
                                                 all.found[0] = all.y.load(kAcquire);
                                                 all.found[1] = all.x.load(kRelaxed);
                                               }});
    // It may have replaced the 0, too: then x is not known.
    EXPECT_TRUE(explored.finds({2, 0}));
    return explored.finds({1, 0});
  };
  EXPECT_FALSE(found_old(kRelease));
  EXPECT_TRUE(found_old(kRelaxed));
}

TEST(Explorer, MutexesExcludeAndPassOnWhatWasDone) {
  const auto add_one = [](Litmus& all) {
    const std::lock_guard<Mutex> lock(all.mutex);
    all.a.write(all.a.read() + 1);
  };
  const Explored explored = explore_threads({add_one, add_one, [](Litmus& all) {
                                               const std::lock_guard<Mutex> lock(all.mutex);
                                               all.found[0] = all.a.read();
                                             }});
  EXPECT_EQ(explored.report.failure, "");
  EXPECT_EQ(explored.outcomes.size(), 3u);
  EXPECT_TRUE(explored.finds({2}));
}

TEST(Explorer, ReportsThreadsThatWaitForEachOther) {
  const Report report = explore_threads({[](Litmus& all) { all.mutex.lock(); },
                                         [](Litmus& all) { all.mutex.lock(); }})
                            .report;
  EXPECT_NE(report.failure.find("every thread waits"), std::string::npos);
}

TEST(Explorer, TellsTheStepsThatLedToAFailure) {
  const std::string failure = plain_message(kRelaxed, kAcquire).failure;
  EXPECT_NE(failure.find("thread 0: stores atomic 1, 1, relaxed\n"), std::string::npos) << failure;
  EXPECT_NE(failure.find("thread 1: loads atomic 1, 1, acquire\n"), std::string::npos) << failure;
}

}  // namespace
}  // namespace planetree::explorer
