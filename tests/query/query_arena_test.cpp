#include "query/serve/query_arena.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "planetree/probe.h"
#include "query/model_state.h"
#include "query/probe_state.h"
#include "tests/cache/allocation_count.h"
#include "tests/query/answer_bits.h"
#include "tests/query/query_costs.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

// Bytes that this process has locked, as reported by the kernel.
std::uint64_t kernel_locked_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmLck:")) return 1024 * std::strtoull(&line[6], nullptr, 10);
  return 0;
}

class QueryArenaTest : public testing::Test {
 protected:
  QueryArenaTest() : sample_(SampleModel::masked(octree::sphere(4))) {
    options_.memory_budget_bytes = std::uint64_t{2} << 20;
    options_.max_probes = 4;
  }

  const SampleModel sample_;
  OpenOptions options_;
};

TEST_F(QueryArenaTest, LockedBytesAgreeWithTheKernel) {
  if (!cache::allocations_are_counted()) GTEST_SKIP() << "sanitizers lock nothing";
  options_.locking = Locking::kRequire;
  const std::uint64_t before = kernel_locked_bytes();
  const auto model = Model::open(sample_.path(), options_);
  if (!model) GTEST_SKIP() << model.error().text;
  const Stats stats = model->stats();
  EXPECT_EQ(kernel_locked_bytes() - before, stats.locked_bytes);
  const QueryArena::Needs needs{.readers = 5,
                                .model_bytes = sizeof(ServingModel),
                                .probe_bytes = sizeof(ProbeState),
                                .side_grid_bytes = 64};
  EXPECT_GE(stats.locked_bytes, stats.arena_bytes + QueryArena::bytes(needs));
}

TEST_F(QueryArenaTest, ReusesProbeStorageAcrossThreads) {
  const Vec3 point{0.3, -1.2, 0.1};
  const auto model = Model::open(sample_.path(), options_);
  ASSERT_TRUE(model);
  const AnswerBits bits = bits_of(make_probe(*model).closest_point(point));
  for (int round = 0; round < 20; ++round) {
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < options_.max_probes; ++i)
      threads.emplace_back([&] {
        // Another thread may still hold a probe, but not for long.
        std::optional<Probe> probe;
        while (!probe)
          if (auto created = Probe::create(*model)) probe.emplace(*std::move(created));
        EXPECT_EQ(bits_of(probe->closest_point(point)), bits);
      });
    for (std::thread& thread : threads) thread.join();
  }
}

// A probe lies in the arena; its one allocation is for batches.
TEST_F(QueryArenaTest, CreatingAProbeAllocatesOnlyForBatches) {
  if (!cache::allocations_are_counted()) GTEST_SKIP() << "a sanitizer counts instead";
  const auto model = Model::open(sample_.path(), options_);
  ASSERT_TRUE(model);
  const std::uint64_t before = cache::allocation_count();
  const Probe probe = make_probe(*model);
  EXPECT_EQ(cache::allocation_count(), before + 1);
}

TEST_F(QueryArenaTest, CountsTowardsTheBudget) {
  if (!cache::allocations_are_counted()) GTEST_SKIP() << "a sanitizer's own memory grows too";
  const std::uint64_t few = sample_.min_budget(4);
  const std::uint64_t before = resident_memory_bytes();
  const Model model = sample_.open(few, 4);
  EXPECT_LE(resident_memory_bytes(), before + few);
  EXPECT_LE(model.stats().arena_bytes + model.stats().table_bytes, few);
}

}  // namespace
}  // namespace planetree::query
