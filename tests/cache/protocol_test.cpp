// Checks the protocol between readers and the writer (cache/protocol.h) with the memory orders
// as shipped. In every run of small programs, and in many runs of larger ones, no reader sees a
// frame that is being written, or another page's frame. Each step is necessary: with its order
// weakened, some run fails.

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>

#include "tests/cache/explored_atomics.h"
#include "tests/cache/explorer/explore.h"
#include "tests/cache/fetch_program.h"
#include "tests/cache/handover_program.h"
#include "tests/cache/turnover_program.h"

namespace planetree::cache {
namespace {

using explorer::explore_all;
using explorer::explore_at_random;
using explorer::kAnyPreemptions;
using explorer::kFewPreemptions;
using explorer::kRandomRuns;
using explorer::MakeProgram;
using explorer::Report;

MakeProgram turnover(const Turnover& options) {
  return [options] { return std::make_unique<TurnoverProgram>(options); };
}

MakeProgram fetching(const Fetching& options) {
  return [options] { return std::make_unique<FetchProgram>(options); };
}

MakeProgram handover() {
  return [] { return std::make_unique<HandoverProgram>(); };
}

class Protocol : public testing::Test {
 protected:
  void SetUp() override { ExploredAtomics::ship_orders(); }
};

TEST_F(Protocol, HoldsInEveryRunOfOneReader) {
  for (const std::uint32_t frames : {1u, 2u}) {
    const Turnover options{.readers = 1, .sections = 2, .frames = frames, .rounds = 2};
    EXPECT_EQ(explore_all(turnover(options), kAnyPreemptions).failure, "") << frames;
  }
}

TEST_F(Protocol, HoldsInEveryRunOfTwoReadersWhilePagesReturnToTheirFrame) {
  const Turnover options{.readers = 2, .sections = 1, .frames = 1, .rounds = 2};
  EXPECT_EQ(explore_all(turnover(options), kAnyPreemptions).failure, "");
}

TEST_F(Protocol, HoldsInEveryRunOfTwoReadersWhilePagesChangeFrames) {
  const Turnover options{.readers = 2, .sections = 1, .frames = 2, .rounds = 1};
  EXPECT_EQ(explore_all(turnover(options), kAnyPreemptions).failure, "");
}

TEST_F(Protocol, HoldsWithFewPreemptionsOfConsecutiveSections) {
  const Turnover options{.readers = 2, .sections = 2, .frames = 1, .rounds = 1};
  EXPECT_EQ(explore_all(turnover(options), kFewPreemptions).failure, "");
}

TEST_F(Protocol, HoldsInRandomRuns) {
  const Turnover options{.readers = 3, .sections = 2, .frames = 2, .rounds = 2};
  const Report report = explore_at_random(turnover(options), kRandomRuns, 1);
  EXPECT_EQ(report.failure, "");
  EXPECT_EQ(report.runs, kRandomRuns);
}

TEST_F(Protocol, HoldsInEveryRunOfTwoFetches) {
  EXPECT_EQ(explore_all(fetching({.threads = 2, .fetches = 1}), kAnyPreemptions).failure, "");
}

TEST_F(Protocol, HoldsWithFewPreemptionsOfFourFetches) {
  EXPECT_EQ(explore_all(fetching({.threads = 2, .fetches = 2}), kFewPreemptions).failure, "");
}

TEST_F(Protocol, HoldsInEveryRunOfTwoFetchesOfOnePage) {
  EXPECT_EQ(explore_all(fetching({.threads = 2, .fetches = 1, .same_page = true}), kAnyPreemptions)
                .failure,
            "");
}

TEST_F(Protocol, HoldsInRandomRunsOfFetches) {
  for (const Fetching& options :
       {Fetching{.threads = 2, .fetches = 3}, Fetching{.threads = 3, .fetches = 2},
        Fetching{.threads = 3, .fetches = 3, .same_page = true}}) {
    const Report report = explore_at_random(fetching(options), kRandomRuns, 1);
    EXPECT_EQ(report.failure, "");
    EXPECT_EQ(report.runs, kRandomRuns);
  }
}

TEST_F(Protocol, HoldsInEveryRunOfTwoReadersThatShareASlot) {
  EXPECT_EQ(explore_all(handover(), kAnyPreemptions).failure, "");
}

// These programs must detect mistakes; otherwise their success would prove nothing.

TEST_F(Protocol, NotingOpenSectionsBeforeHidingThePageIsCaught) {
  const Report report = explore_all(turnover({.notes_sections_too_early = true}), kFewPreemptions);
  EXPECT_NE(report.failure.find("data race"), std::string::npos);
}

TEST_F(Protocol, FillingAFrameWithoutWaitingIsCaught) {
  const Report report = explore_all(turnover({.reuses_at_once = true}), kFewPreemptions);
  EXPECT_NE(report.failure.find("data race"), std::string::npos);
}

TEST_F(Protocol, PublishingAFrameUnderAnotherPageIsCaught) {
  const Report report = explore_all(turnover({.shows_the_wrong_page = true}), kFewPreemptions);
  EXPECT_NE(report.failure.find("a frame of another page"), std::string::npos);
}

TEST_F(Protocol, EnteringWithoutTheMutexAfterAFetchIsCaught) {
  const Report report =
      explore_all(fetching({.threads = 2, .fetches = 1, .enters_too_late = true}), kFewPreemptions);
  EXPECT_NE(report.failure.find("data race"), std::string::npos);
}

TEST_F(Protocol, EvictingAnAwaitedPageIsCaught) {
  const Report report = explore_at_random(
      fetching({.threads = 3, .fetches = 2, .same_page = true, .does_not_hold_frames = true}),
      kRandomRuns, 1);
  EXPECT_NE(report.failure, "");
}

struct Weakened {
  const char* name;
  ProtocolStep step;
  std::memory_order order;
};

constexpr Weakened kWeakenedSteps[] = {
    {"R1Release", ProtocolStep::kEnter, std::memory_order_release},
    {"R1Relaxed", ProtocolStep::kEnter, std::memory_order_relaxed},
    {"R2Acquire", ProtocolStep::kFind, std::memory_order_acquire},
    {"R2Relaxed", ProtocolStep::kFind, std::memory_order_relaxed},
    {"R5Relaxed", ProtocolStep::kLeave, std::memory_order_relaxed},
    {"E2Release", ProtocolStep::kWithdraw, std::memory_order_release},
    {"E2Relaxed", ProtocolStep::kWithdraw, std::memory_order_relaxed},
    {"E3Acquire", ProtocolStep::kNoteSections, std::memory_order_acquire},
    {"E3Relaxed", ProtocolStep::kNoteSections, std::memory_order_relaxed},
    {"E5Relaxed", ProtocolStep::kSeeSectionEnd, std::memory_order_relaxed},
    {"I7Relaxed", ProtocolStep::kPublish, std::memory_order_relaxed},
    {"ClaimRelaxed", ProtocolStep::kClaim, std::memory_order_relaxed},
    {"GiveUpRelaxed", ProtocolStep::kRelease, std::memory_order_relaxed},
};

class WeakenedStep : public testing::TestWithParam<Weakened> {
 protected:
  void SetUp() override {
    ExploredAtomics::ship_orders();
    ExploredAtomics::set_order(GetParam().step, GetParam().order);
  }
};

TEST_P(WeakenedStep, MakesSomeRunFail) {
  const ProtocolStep step = GetParam().step;
  const bool of_slot = step == ProtocolStep::kClaim || step == ProtocolStep::kRelease;
  const MakeProgram make = of_slot ? handover() : turnover({});
  for (const Report& report :
       {explore_all(make, kFewPreemptions), explore_at_random(make, kRandomRuns, 1)}) {
    EXPECT_NE(report.failure.find("data race"), std::string::npos) << report.failure;
  }
}

INSTANTIATE_TEST_SUITE_P(Protocol, WeakenedStep, testing::ValuesIn(kWeakenedSteps),
                         [](const testing::TestParamInfo<Weakened>& weakened) {
                           return std::string(weakened.param.name);
                         });

}  // namespace
}  // namespace planetree::cache
