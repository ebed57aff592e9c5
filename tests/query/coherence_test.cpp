#include "query/answer/query_context.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "query/model_state.h"
#include "query/probe_state.h"
#include "tests/query/answer_bits.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

// A path near the surface, then jumps: what a probe keeps is used, renewed and forgotten.
std::vector<Vec3> path_and_jumps() {
  std::vector<Vec3> path;
  for (int i = 0; i < 400; ++i) path.push_back({1.02 - i * 1e-4, i * 2e-4, i * 1e-4});
  for (const Vec3& jump : random_queries(200, -1.2, 1.2)) path.push_back(jump);
  return path;
}

class CoherenceTest : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Budgets, CoherenceTest,
                         testing::Values(std::uint64_t{600} << 10, std::uint64_t{64} << 20));

TEST_P(CoherenceTest, ChangesNoBitOfAnExactAnswer) {
  const SampleModel sample = SampleModel::masked(octree::sphere(5));
  OpenOptions options;
  options.memory_budget_bytes = GetParam();
  options.max_probes = 2;
  const auto model = ModelState::open(sample.path(), options);
  ASSERT_TRUE(model) << model.error().text;
  const auto kept = ProbeState::create((*model)->serving(), *(*model)->claim_reader());
  const auto fresh = ProbeState::create((*model)->serving(), *(*model)->claim_reader());
  fresh->coherence().is_on = false;
  for (const Vec3& query : path_and_jumps()) {
    const ClosestPoint expected = fresh->closest_point(query, {});
    ASSERT_EQ(expected.status, Status::kExact);
    ASSERT_EQ(bits_of(kept->closest_point(query, {})), bits_of(expected));
    ASSERT_EQ(kept->contains(query, {}).side, fresh->contains(query, {}).side);
  }
}

}  // namespace
}  // namespace planetree::query
