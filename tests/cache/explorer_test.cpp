#include <gtest/gtest.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "tests/cache/litmus.h"

namespace planetree::explorer {
namespace {

/// Two visible steps that no load can tell apart.
void exchange_twice(Litmus& all) {
  all.z.exchange(1, kRelaxed);
  all.z.exchange(1, kRelaxed);
}

TEST(Explorer, RunsEverySchedule) {
  // The number of ways to choose the first thread's steps among four.
  EXPECT_EQ(explore_threads({exchange_twice, exchange_twice}).report.runs, 6u);
}

TEST(Explorer, PreemptsNoMoreOftenThanTheLimit) {
  const std::vector<Body> bodies{exchange_twice, exchange_twice};
  Outcomes outcomes;
  const auto make = [&] { return std::make_unique<LitmusProgram>(bodies, outcomes); };
  EXPECT_EQ(explore_all(make, 0).runs, 2u);
  EXPECT_EQ(explore_all(make, 1).runs, 4u);
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
  // The load shows that the reader is done. Without acquire and release this does not make the read
  // happen before the write.
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

TEST(Explorer, ReportsAWriteAfterAWriteAsARace) {
  const auto write = [](Litmus& all) { all.a.write(1); };
  EXPECT_NE(explore_threads({write, write}).report.failure.find("a write after"),
            std::string::npos);
}

TEST(Explorer, PlainVariablesDoNotRaceWithEachOther) {
  const Report report =
      explore_threads({[](Litmus& all) { all.a.write(1); }, [](Litmus& all) { all.b.write(1); }})
          .report;
  EXPECT_EQ(report.failure, "");
}

TEST(Explorer, ReadsDoNotRaceWithReads) {
  const auto read = [](Litmus& all) { all.a.read(); };
  EXPECT_EQ(explore_threads({read, read, read}).report.failure, "");
}

TEST(Explorer, MutexExcludesAndOrdersCriticalSections) {
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

TEST(Explorer, ReportsDeadlock) {
  const Report report = explore_threads({[](Litmus& all) { all.mutex.lock(); },
                                         [](Litmus& all) { all.mutex.lock(); }})
                            .report;
  EXPECT_NE(report.failure.find("every thread waits"), std::string::npos);
}

TEST(Explorer, ReportsAThreadThatNeverEnds) {
  const Report report = explore_threads({[](Litmus& all) {
                          while (all.x.load(kRelaxed) == 0) {
                          }
                        }}).report;
  EXPECT_NE(report.failure.find("a thread does not end"), std::string::npos);
}

TEST(Explorer, YieldLetsAnotherThreadRun) {
  const Explored explored = explore_threads({[](Litmus& all) {
                                               Execution::current().yield();
                                               all.found[0] = all.x.exchange(1, kRelaxed);
                                             },
                                             [](Litmus& all) { all.x.exchange(2, kRelaxed); }});
  EXPECT_EQ(explored.outcomes, Outcomes({{2, -1, -1, -1}}));
}

TEST(Explorer, FailureListsTheStepsThatLedToIt) {
  const std::string failure = plain_message(kRelaxed, kAcquire).failure;
  EXPECT_NE(failure.find("thread 0: stores atomic 1, 1, relaxed\n"), std::string::npos) << failure;
  EXPECT_NE(failure.find("thread 1: loads atomic 1, 1, acquire\n"), std::string::npos) << failure;
}

}  // namespace
}  // namespace planetree::explorer
