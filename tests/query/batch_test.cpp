#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <limits>
#include <thread>

#include "planetree/probe.h"
#include "query/serve/batch_order.h"
#include "tests/octree/support/odd_arithmetic.h"
#include "tests/query/answer_bits.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

class Batch : public testing::Test {
 protected:
  static constexpr std::size_t kWindow = BatchBuffers::kMax;

  // More queries than a probe's batch buffers hold, so that the memory of the last answers is used
  // too; some queries are unusual.
  Batch() : sample_(octree::sphere(4)), queries_(random_queries(kWindow * 5 / 4, -1.5, 1.5)) {
    queries_[3] = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
    queries_[kWindow - 1] = {1e300, -1e300, 0};
    queries_[kWindow] = {0, std::numeric_limits<double>::infinity(), 0};
    queries_[2000] = queries_[17];
    queries_[2001] = {1e20, 1, 1};
  }

  void expect_as_one_by_one(const QueryOptions& options, unsigned threads = 1) {
    const Model model = sample_.open_for_batches(threads);
    Probe probe = make_probe(model);
    std::vector<ClosestPoint> answers(queries_.size());
    probe.closest_points(queries_, answers, options);
    for (std::size_t i = 0; i < queries_.size(); ++i)
      ASSERT_EQ(bits_of(answers[i]), bits_of(probe.closest_point(queries_[i], options))) << i;
  }

  SampleModel sample_;
  std::vector<Vec3> queries_;
};

TEST_F(Batch, AnswersHaveTheBitsOfSingleQueries) { expect_as_one_by_one({}); }

TEST_F(Batch, AnswersAreTheSameWithAnyNumberOfThreads) {
  for (const unsigned threads : {2u, 3u, 16u}) expect_as_one_by_one({}, threads);
}

TEST_F(Batch, SidesAreTheSameWithSeveralThreads) {
  const Model model = sample_.open_for_batches(2);
  Probe probe = make_probe(model);
  std::vector<Containment> answers(queries_.size());
  probe.contains(queries_, answers);
  for (std::size_t i = 0; i < queries_.size(); ++i) {
    ASSERT_EQ(answers[i].side, probe.contains(queries_[i]).side) << i;
    ASSERT_EQ(answers[i].status, probe.contains(queries_[i]).status) << i;
  }
}

// A batch that starts while the batch threads are busy is answered by its own thread alone.
TEST_F(Batch, ConcurrentBatchesGetTheSameAnswers) {
  const Model model = sample_.open_for_batches(2, 4);
  std::vector<std::vector<ClosestPoint>> answers(4, std::vector<ClosestPoint>(queries_.size()));
  std::vector<std::thread> queriers;
  for (auto& own : answers)
    queriers.emplace_back([&] { make_probe(model).closest_points(queries_, own); });
  for (std::thread& querier : queriers) querier.join();
  for (std::size_t i = 0; i < queries_.size(); ++i)
    for (const auto& own : answers) ASSERT_EQ(bits_of(own[i]), bits_of(answers[0][i])) << i;
}

// The caller rounds up and flushes to zero; the batch threads do not.
TEST_F(Batch, AnswersAreTheSameInAnyFloatingPointMode) {
  const Model model = sample_.open_for_batches(2);
  Probe probe = make_probe(model);
  std::vector<ClosestPoint> plain(queries_.size()), odd(queries_.size());
  probe.closest_points(queries_, plain);
  {
    const OddArithmetic arithmetic(FE_UPWARD);
    probe.closest_points(queries_, odd);
  }
  for (std::size_t i = 0; i < queries_.size(); ++i)
    ASSERT_EQ(bits_of(odd[i]), bits_of(plain[i])) << i;
}

// One by one, limited queries may profit from earlier ones; in a batch they do not.
TEST_F(Batch, LimitedAnswersAreTheSameInAnyOrder) {
  const Model model = sample_.open();
  const QueryOptions limits[] = {
      {.max_error = 0.05},
      {.max_work = 12},
      {.max_error = 0.1, .max_distance = 0.5, .max_work = 12},
  };
  for (const QueryOptions& options : limits) {
    std::vector<ClosestPoint> answers(queries_.size()), reversed(queries_.size());
    Probe probe = make_probe(model);
    probe.closest_points(queries_, answers, options);
    for (const Vec3& query : queries_) probe.closest_point(query, options);
    std::ranges::reverse(queries_);
    probe.closest_points(queries_, reversed, options);
    std::ranges::reverse(queries_);
    std::ranges::reverse(reversed);
    int inexact = 0;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      ASSERT_EQ(bits_of(reversed[i]), bits_of(answers[i])) << i;
      inexact +=
          answers[i].status == Status::kWithinError || answers[i].status == Status::kDegraded;
    }
    EXPECT_GT(inexact, 10);
  }
}

TEST_F(Batch, AnswersAreTheSameInAnyOrderAndBudget) {
  const Model large = sample_.open(), small = sample_.open(sample_.min_budget());
  Probe of_large = make_probe(large), of_small = make_probe(small);
  std::vector<ClosestPoint> answers(queries_.size()), reversed(queries_.size());
  of_large.closest_points(queries_, answers);
  std::ranges::reverse(queries_);
  of_small.closest_points(queries_, reversed);
  std::ranges::reverse(reversed);
  for (std::size_t i = 0; i < answers.size(); ++i)
    ASSERT_EQ(bits_of(reversed[i]), bits_of(answers[i])) << i;
}

TEST_F(Batch, AnswersAreTheSameForAnySize) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  probe.closest_points({}, {});
  std::vector<ClosestPoint> expected;
  for (const Vec3& query : queries_) expected.push_back(probe.closest_point(query));
  // From one of these sizes on the memory of answers is used, as little of it as possible.
  const std::size_t lent = kWindow + kWindow / (sizeof(ClosestPoint) / sizeof(std::uint64_t));
  for (const std::size_t size : {std::size_t{1}, std::size_t{2}, kWindow - 1, kWindow, kWindow + 1,
                                 lent, lent + 1, lent + 2, lent + 3}) {
    std::vector<ClosestPoint> answers(size);
    probe.closest_points(std::span(queries_).first(size), answers);
    for (std::size_t i = 0; i < size; ++i)
      ASSERT_EQ(bits_of(answers[i]), bits_of(expected[i])) << i << " of " << size;
  }
}

// The memory of the last answers holds the order of the others, several times in turn.
TEST_F(Batch, AnswersAreTheSameForABatchManyTimesTheBuffers) {
  const SampleModel small(octree::sphere(0));
  const Model model = small.open();
  Probe probe = make_probe(model);
  const std::vector<Vec3> queries = random_queries(18 * kWindow, -1.5, 1.5);
  std::vector<ClosestPoint> answers(queries.size());
  const QueryOptions options{.parts = kDistance};
  probe.closest_points(queries, answers, options);
  for (std::size_t i = 0; i < queries.size(); ++i)
    ASSERT_EQ(bits_of(answers[i]), bits_of(probe.closest_point(queries[i], options))) << i;
}

TEST_F(Batch, ReadsFewerPagesThanSingleQueries) {
  const std::uint64_t budget = sample_.min_budget() + sample_.page_count() / 3 * 4096;
  const Model one = sample_.open(budget), batch = sample_.open(budget);
  ASSERT_LT(one.stats().frames, sample_.page_count());
  Probe of_one = make_probe(one), of_batch = make_probe(batch);
  std::vector<ClosestPoint> answers(queries_.size());
  for (const Vec3& query : queries_) of_one.closest_point(query);
  of_batch.closest_points(queries_, answers);
  EXPECT_LT(batch.stats().pages_read * 2, one.stats().pages_read);
}

// A batch is ordered as a whole, not in parts that fit a probe's buffers.
TEST_F(Batch, ReadsFewerPagesAsOneBatchThanInParts) {
  const std::uint64_t budget = sample_.min_budget() + sample_.page_count() / 3 * 4096;
  const std::vector<Vec3> queries = random_queries(8 * kWindow, -1.5, 1.5);
  std::vector<ClosestPoint> answers(queries.size());
  const auto pages_read = [&](std::size_t size) {
    const Model model = sample_.open(budget);
    Probe probe = make_probe(model);
    for (std::size_t first = 0; first < queries.size(); first += size)
      probe.closest_points(std::span(queries).subspan(first, size),
                           std::span(answers).subspan(first, size), {.parts = kDistance});
    return model.stats().pages_read;
  };
  const std::uint64_t at_once = pages_read(queries.size()), in_parts = pages_read(kWindow);
  EXPECT_LT(at_once * 4, in_parts * 3);
}

}  // namespace
}  // namespace planetree::query
