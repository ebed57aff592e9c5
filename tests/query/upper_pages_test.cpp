#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>

#include "planetree/probe.h"
#include "query/model_state.h"
#include "tests/query/sample_model.h"

// Pages that link to others stay in memory where it is short.
namespace planetree::query {
namespace {

constexpr std::uint32_t kPageBytes = 16384;

std::uint64_t pages_read(const SampleModel& sample, EvictionPolicy policy) {
  OpenOptions options;
  options.memory_budget_bytes = sample.min_budget() + sample.page_count() / 8 * kPageBytes;
  options.max_probes = 1;
  options.policy = policy;
  const auto model = ModelState::open_model(sample.path(), options, {.starts_fetching = false});
  if (!model) std::abort();
  Probe probe = make_probe(*model);
  octree::Noise noise(1);
  for (int i = 0; i < 4000; ++i) (void)probe.closest_point(noise.point(-1.5, 1.5));
  return model->stats().pages_read;
}

// LRU does not distinguish upper pages. If CLOCK did not either, it would read as many pages as
// LRU.
TEST(UpperPages, StayWhereMemoryIsShort) {
  const SampleModel sample(octree::sphere(6), kPageBytes);
  const std::uint64_t clock = pages_read(sample, EvictionPolicy::kClock);
  const std::uint64_t lru = pages_read(sample, EvictionPolicy::kLru);
  EXPECT_LT(clock, lru * 93 / 100);
}

}  // namespace
}  // namespace planetree::query
