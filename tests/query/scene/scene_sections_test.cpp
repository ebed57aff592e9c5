// SceneSections over atomics that show every behaviour the language allows: no probe uses a model
// that is being closed, and with one memory order weakened some run fails.

#include "query/scene/scene_sections.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <span>

#include "tests/cache/explored_atomics.h"
#include "tests/cache/explorer/explore.h"

namespace planetree::query {
namespace {

using cache::ExploredAtomics;
using cache::ProtocolStep;
using Sections = BasicSceneSections<ExploredAtomics>;

/// One thread removes the only instance of a model and closes the model, as soon as it may. The
/// others use the model for as long as their views have it.
class RemovalProgram final : public explorer::Program {
 public:
  RemovalProgram(std::uint32_t probes, std::uint32_t sections, std::uint64_t& uses,
                 std::uint64_t& closings)
      : probes_(probes), rounds_(sections), uses_(uses), closings_(closings) {}

  std::uint32_t thread_count() const noexcept override { return probes_ + 1; }
  void run(std::uint32_t thread) override {
    if (thread == probes_) {
      remove();
    } else {
      query(thread);
    }
  }

 private:
  void query(std::uint32_t probe) {
    std::uint64_t seen = 0;
    bool has_model = true;
    for (std::uint32_t i = 0; i < rounds_; ++i) {
      const std::uint64_t changes = sections().enter(probe);
      if (changes != seen) has_model = instance_.load(std::memory_order_relaxed) != 0;
      seen = changes;
      if (has_model) {
        model_.read();
        ++uses_;
      }
      sections().leave(probe);
    }
  }

  void remove() {
    instance_.store(0, std::memory_order_relaxed);
    sections().count_change();
    std::array<std::uint64_t, kMaxProbes> open{};
    for (std::uint32_t probe = 0; probe < probes_; ++probe)
      open[probe] = sections().section_of(probe);
    for (std::uint32_t probe = 0; probe < probes_; ++probe) {
      if (sections().is_over(probe, open[probe])) continue;
      explorer::Execution::current().yield();
      if (!sections().is_over(probe, open[probe])) return;
    }
    model_.write(0);
    ++closings_;
  }

  Sections sections() { return {std::span(slots_), changes_}; }

  static constexpr std::uint32_t kMaxProbes = 2;

  const std::uint32_t probes_, rounds_;
  std::uint64_t &uses_, &closings_;
  std::array<Sections::Slot, kMaxProbes> slots_;
  Sections::Counter changes_{0};
  explorer::Atomic<std::uint64_t> instance_{1};
  explorer::Plain<int> model_{1};
};

explorer::Report explore(std::uint32_t probes, std::uint32_t sections, std::uint32_t preemptions) {
  std::uint64_t uses = 0, closings = 0;
  explorer::Report report = explorer::explore_all(
      [&] { return std::make_unique<RemovalProgram>(probes, sections, uses, closings); },
      preemptions);
  EXPECT_TRUE((uses > 0 && closings > 0) || !report.failure.empty());
  return report;
}

class SceneSectionsTest : public testing::Test {
 protected:
  void SetUp() override { ExploredAtomics::ship_orders(); }
  void TearDown() override { ExploredAtomics::ship_orders(); }
};

TEST_F(SceneSectionsTest, KeepModelsInEveryRunOfOneProbe) {
  EXPECT_EQ(explore(1, 2, explorer::kAnyPreemptions).failure, "");
}

TEST_F(SceneSectionsTest, KeepModelsForTwoProbes) {
  EXPECT_EQ(explore(2, 1, explorer::kAnyPreemptions).failure, "");
  EXPECT_EQ(explore(2, 2, explorer::kFewPreemptions).failure, "");
}

struct Weakened {
  ProtocolStep step;
  std::memory_order order;
};

class WeakenedSceneSections : public testing::TestWithParam<Weakened> {
 protected:
  void SetUp() override {
    ExploredAtomics::ship_orders();
    ExploredAtomics::set_order(GetParam().step, GetParam().order);
  }
  void TearDown() override { ExploredAtomics::ship_orders(); }
};

TEST_P(WeakenedSceneSections, MakeSomeRunFail) {
  EXPECT_NE(explore(1, 2, explorer::kFewPreemptions).failure, "");
}

INSTANTIATE_TEST_SUITE_P(
    Steps, WeakenedSceneSections,
    testing::Values(Weakened{ProtocolStep::kEnter, std::memory_order_release},
                    Weakened{ProtocolStep::kFind, std::memory_order_acquire},
                    Weakened{ProtocolStep::kFind, std::memory_order_relaxed},
                    Weakened{ProtocolStep::kLeave, std::memory_order_relaxed},
                    Weakened{ProtocolStep::kWithdraw, std::memory_order_relaxed},
                    Weakened{ProtocolStep::kNoteSections, std::memory_order_acquire},
                    Weakened{ProtocolStep::kSeeSectionEnd, std::memory_order_relaxed}));

}  // namespace
}  // namespace planetree::query
