#include "query/answer/query_context.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
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

// A model opened with the memory of the parameter.
class CoherenceTest : public testing::TestWithParam<std::uint64_t> {
 protected:
  void SetUp() override {
    OpenOptions options;
    options.memory_budget_bytes = GetParam();
    options.max_probes = 2;
    auto model = ModelState::open(sample_.path(), options);
    ASSERT_TRUE(model) << model.error().text;
    model_ = *std::move(model);
  }
  std::unique_ptr<ProbeState> probe() {
    return ProbeState::create(model_->serving(), *model_->claim_reader());
  }

  const SampleModel sample_ = SampleModel::masked(octree::sphere(5));
  std::unique_ptr<ModelState> model_;
};
INSTANTIATE_TEST_SUITE_P(Budgets, CoherenceTest,
                         testing::Values(std::uint64_t{728} << 10, std::uint64_t{64} << 20));

TEST_P(CoherenceTest, ChangesNoBitOfAnExactAnswer) {
  const auto kept = probe(), fresh = probe();
  fresh->coherence().is_on = false;
  for (const Vec3& query : path_and_jumps()) {
    const ClosestPoint expected = fresh->closest_point(query, {});
    ASSERT_EQ(expected.status, Status::kExact);
    ASSERT_EQ(bits_of(kept->closest_point(query, {})), bits_of(expected));
    ASSERT_EQ(kept->contains(query, {}).side, fresh->contains(query, {}).side);
  }
}

// Page lookups of a path of queries, by a probe of its own.
std::uint64_t lookups(ModelState& model, QueryOptions options) {
  options.parts = kDistance;
  const auto probe = ProbeState::create(model.serving(), *model.claim_reader());
  const Stats before = model.stats();
  for (const Vec3& query : path_and_jumps()) probe->closest_point(query, options);
  const Stats after = model.stats();
  return after.page_hits + after.page_misses - before.page_hits - before.page_misses;
}

TEST_P(CoherenceTest, AnAllowedErrorCostsNoMoreThanNone) {
  lookups(*model_, {});
  const std::uint64_t exact = lookups(*model_, {});
  for (const double error : {1e-5, 1e-3, 1e-2, 1e-1})
    EXPECT_LE(lookups(*model_, {.max_error = error}), exact * 102 / 100) << error;
}

TEST_P(CoherenceTest, ALimitOfWorkCostsNoMoreThanNone) {
  lookups(*model_, {});
  const std::uint64_t exact = lookups(*model_, {});
  for (const std::uint32_t work : {64U, 512U, 4096U})
    EXPECT_LE(lookups(*model_, {.max_work = work}), exact * 102 / 100) << work;
}

// What limited work finds depends on the last answer, but its intervals hold.
TEST_P(CoherenceTest, LeavesLimitedAnswersInTheirIntervals) {
  const auto kept = probe(), fresh = probe();
  fresh->coherence().is_on = false;
  int degraded = 0;
  std::uint32_t at = 0;
  for (const Vec3& query : path_and_jumps()) {
    const ClosestPoint exact = fresh->closest_point(query, {});
    const ClosestPoint answer = kept->closest_point(query, {.max_work = 1U << (at++ % 10)});
    EXPECT_LE(answer.lower, exact.upper);
    EXPECT_GE(answer.upper, exact.lower);
    EXPECT_TRUE(answer.side == exact.side || answer.side == Side::kUnknown);
    if (answer.status == Status::kExact) {
      EXPECT_EQ(bits_of(answer), bits_of(exact));
    } else {
      ++degraded;
      EXPECT_EQ(answer.status, Status::kDegraded);
    }
  }
  EXPECT_GT(degraded, 20);
}

// With all pages in memory: where pages come and go, lookups depend on when they do.
TEST(CoherenceOfAResidentModel, AnAllowedErrorCostsNoMoreThanNoneWithoutWaiting) {
  const SampleModel sample = SampleModel::masked(octree::sphere(5));
  auto opened = ModelState::open(sample.path(), {.max_probes = 2});
  ASSERT_TRUE(opened) << opened.error().text;
  ModelState& model = **opened;
  lookups(model, {});
  const std::uint64_t exact = lookups(model, {.wait = Wait::kNever});
  for (const double error : {1e-5, 1e-3, 1e-2, 1e-1})
    EXPECT_LE(lookups(model, {.wait = Wait::kNever, .max_error = error}), exact * 102 / 100)
        << error;
}

// Near the last query an exact answer is sought, and one that lacks pages may be within the error.
TEST_P(CoherenceTest, RealTimeAnswersTellWhetherTheyAreWithinTheError) {
  const auto kept = probe(), fresh = probe();
  int within_error = 0;
  for (const Vec3& query : path_and_jumps()) {
    const ClosestPoint exact = fresh->closest_point(query, {.parts = kDistance});
    const ClosestPoint answer =
        kept->closest_point(query, {.parts = kDistance, .wait = Wait::kNever, .max_error = 2e-2});
    EXPECT_LE(answer.lower, exact.upper);
    EXPECT_GE(answer.upper, exact.lower);
    const bool is_narrow = answer.upper - answer.lower <= 2e-2;
    const bool has_triangle = answer.triangle != kNoTriangle;
    EXPECT_TRUE(answer.status != Status::kWithinError || is_narrow);
    EXPECT_TRUE(answer.status != Status::kDegraded || !is_narrow || !has_triangle);
    within_error += answer.status == Status::kWithinError;
  }
  EXPECT_GT(within_error, 20);
}

TEST_P(CoherenceTest, LeavesAllowedErrorsInTheirIntervals) {
  const auto kept = probe(), fresh = probe();
  fresh->coherence().is_on = false;
  int within_error = 0, at = 0;
  for (const Vec3& query : path_and_jumps()) {
    const ClosestPoint exact = fresh->closest_point(query, {});
    const double error = ++at % 3 == 0 ? 0 : at % 3 == 1 ? 1e-3 : 1e-1;
    const ClosestPoint answer = kept->closest_point(query, {.max_error = error});
    EXPECT_LE(answer.lower, exact.upper);
    EXPECT_GE(answer.upper, exact.lower);
    EXPECT_EQ(answer.side, exact.side);
    if (answer.status == Status::kExact) {
      EXPECT_EQ(bits_of(answer), bits_of(exact));
    } else {
      ++within_error;
      EXPECT_EQ(answer.status, Status::kWithinError);
      EXPECT_LE(answer.upper - answer.lower, error);
    }
  }
  EXPECT_GT(within_error, 20);
}

}  // namespace
}  // namespace planetree::query
