// Counts the costs that check_query_costs counts, over far fewer queries than its ten million.

#include <gtest/gtest.h>

#include "tests/cache/allocation_count.h"
#include "tests/query/lock_count.h"
#include "tests/query/query_costs.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

class RealTimeQueryCosts : public testing::TestWithParam<std::uint32_t> {};

TEST_P(RealTimeQueryCosts, AllocateLockCallAndFaultNothing) {
  if (!cache::allocations_are_counted() || !locks_are_counted())
    GTEST_SKIP() << "a sanitizer counts instead";
  const SampleModel sample = SampleModel::masked(octree::sphere(5));
  const std::vector<Vec3> points = random_queries(3000, -1.2, 1.2);
  const std::uint64_t resident = resident_memory_bytes();
  ASSERT_GT(resident, 0u);
  OpenOptions options;
  options.max_probes = 1;
  options.page_trace_capacity = GetParam();
  options.memory_budget_bytes = sample.min_budget() + 8 * 4096 + GetParam() * 100;
  const auto opened = Model::open(sample.path(), options);
  ASSERT_TRUE(opened);
  const Model& model = *opened;
  Probe probe = make_probe(model);
  std::uint64_t evicted = 0, degraded = 0;
  for (int most = 100; most > 0 && evicted < 300; --most) {
    const QueryCosts costs = measure_queries(model, probe, points, 6000, 6000, resident);
    EXPECT_EQ(costs.allocations, 0u);
    EXPECT_EQ(costs.locks, 0u);
    EXPECT_EQ(costs.calls, 0u);
    EXPECT_EQ(costs.faults, 0u);
    EXPECT_EQ(costs.grown_bytes, 0u);
    EXPECT_EQ(costs.over_budget_bytes, 0u);
    evicted += costs.pages_evicted;
    degraded += costs.degraded;
  }
  EXPECT_GE(evicted, 300u);
  EXPECT_GT(degraded, 0u);
  // The trace was never drained.
  EXPECT_EQ(model.stats().page_trace_dropped > 0, GetParam() > 0);
}

INSTANTIATE_TEST_SUITE_P(TracedAccesses, RealTimeQueryCosts, testing::Values(0, 128));

}  // namespace
}  // namespace planetree::query
