// SeqLock over atomics that show every behaviour the language allows.

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "query/serve/seq_lock.h"
#include "tests/cache/explorer/atomic.h"
#include "tests/cache/explorer/explore.h"

namespace planetree::explorer {
namespace {

using query::SeqLock;
using query::SeqLockStep;

/// The order of one step may be weakened.
struct ExploredSeqLock {
  template <class T>
  using Atomic = explorer::Atomic<T>;

  static std::memory_order order(SeqLockStep step) noexcept {
    return weakened && step == *weakened ? std::memory_order_relaxed : query::order_of(step);
  }
  static inline const SeqLockStep* weakened = nullptr;
};

struct Twice {
  std::uint64_t value = 0, again = 0;
};

/// One thread gives 1 and 2; the others try to take both.
class SeqLockProgram final : public Program {
 public:
  SeqLockProgram(std::uint32_t takers, std::uint64_t& lasts_taken)
      : takers_(takers), lasts_taken_(lasts_taken) {}

  std::uint32_t thread_count() const noexcept override { return takers_ + 1; }

  void run(std::uint32_t thread) override {
    if (thread == takers_) {
      latest_.store({1, 1});
      latest_.store({2, 2});
    } else {
      std::uint64_t seen = 0, last = 0;
      for (int i = 0; i < 2; ++i) last = take(seen, last);
    }
  }

 private:
  std::uint64_t take(std::uint64_t& seen, std::uint64_t last) {
    Twice taken;
    if (!latest_.load_newer(seen, taken)) return last;
    if (taken.value != taken.again) Execution::current().fail("a torn value");
    if (taken.value <= last) Execution::current().fail("no newer value");
    lasts_taken_ += taken.value == 2 ? 1 : 0;
    return taken.value;
  }

  const std::uint32_t takers_;
  std::uint64_t& lasts_taken_;
  SeqLock<Twice, ExploredSeqLock> latest_;
};

Report explore_seq_lock(std::uint32_t takers, std::uint32_t max_preemptions) {
  std::uint64_t lasts_taken = 0;
  Report report = explore_all([&] { return std::make_unique<SeqLockProgram>(takers, lasts_taken); },
                              max_preemptions);
  EXPECT_TRUE(lasts_taken > 0 || !report.failure.empty());
  return report;
}

TEST(SeqLockOrder, ValuesAreNeverTornInAnyRun) {
  EXPECT_EQ(explore_seq_lock(1, kAnyPreemptions).failure, "");
}

TEST(SeqLockOrder, ValuesAreNeverTornForTwoTakers) {
  EXPECT_EQ(explore_seq_lock(2, kFewPreemptions).failure, "");
}

class WeakenedSeqLock : public testing::TestWithParam<SeqLockStep> {
 protected:
  void SetUp() override { ExploredSeqLock::weakened = &GetParam(); }
  void TearDown() override { ExploredSeqLock::weakened = nullptr; }
};

TEST_P(WeakenedSeqLock, MakesSomeRunFail) {
  EXPECT_NE(explore_seq_lock(1, kFewPreemptions).failure, "");
}

INSTANTIATE_TEST_SUITE_P(Steps, WeakenedSeqLock,
                         testing::Values(SeqLockStep::kStoreWord, SeqLockStep::kStoreSequence,
                                         SeqLockStep::kLoadSequence, SeqLockStep::kLoadWord));

}  // namespace
}  // namespace planetree::explorer
