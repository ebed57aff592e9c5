#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "planetree/probe.h"
#include "query/model_state.h"
#include "tests/query/answer_bits.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

constexpr unsigned kThreads = 16;

// Every thread makes all queries, each starting elsewhere, with hardly any memory: the threads
// evict each other's pages all the time.
TEST(Threads, GetTheSameBitsAtTheMinimumBudget) {
  const SampleModel sample(octree::sphere(5));
  const std::vector<Vec3> queries = random_queries(400, -1.3, 1.3);
  std::vector<AnswerBits> expected;
  {
    const Model model = sample.open();
    Probe probe = make_probe(model);
    for (const Vec3& query : queries) expected.push_back(bits_of(probe.closest_point(query)));
  }
  const Model model = sample.open(sample.min_budget(kThreads), kThreads);
  ASSERT_LT(model.stats().frames, sample.page_count() / 2);
  std::vector<std::vector<ClosestPoint>> answers(kThreads);
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < kThreads; ++t)
    threads.emplace_back([&, t] {
      Probe probe = make_probe(model);
      std::vector<ClosestPoint>& own = answers[t];
      own.resize(queries.size());
      for (std::size_t i = 0; i < queries.size(); ++i) {
        const std::size_t at = (i + t * queries.size() / kThreads) % queries.size();
        own[at] = probe.closest_point(queries[at]);
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (unsigned t = 0; t < kThreads; ++t)
    for (std::size_t i = 0; i < queries.size(); ++i)
      ASSERT_EQ(bits_of(answers[t][i]), expected[i]) << t << ' ' << i;
  EXPECT_GT(model.stats().pages_evicted, 500u);
  EXPECT_EQ(model.stats().degraded_answers, 0u);
}

TEST(Threads, GetTheSameBitsUnderAnyEvictionPolicy) {
  const SampleModel sample = SampleModel::masked(octree::sphere(5));
  const std::vector<Vec3> queries = random_queries(300, -1.3, 1.3);
  std::vector<std::vector<AnswerBits>> answers;
  for (const EvictionPolicy policy :
       {EvictionPolicy::kClock, EvictionPolicy::kLru, EvictionPolicy::kSieve,
        EvictionPolicy::kS3Fifo, EvictionPolicy::kTwoQ}) {
    OpenOptions options;
    options.max_probes = 4;
    options.policy = policy;
    // Other policies take some bytes more than CLOCK.
    options.memory_budget_bytes = sample.min_budget(4) + 4096;
    const auto model = Model::open(sample.path(), options);
    ASSERT_TRUE(model);
    std::vector<std::vector<AnswerBits>> own(4);
    std::vector<std::thread> threads;
    for (unsigned t = 0; t < 4; ++t)
      threads.emplace_back([&, t] {
        Probe probe = make_probe(*model);
        for (const Vec3& query : queries) own[t].push_back(bits_of(probe.closest_point(query)));
      });
    for (std::thread& thread : threads) thread.join();
    EXPECT_GT(model->stats().pages_evicted, 500u);
    answers.insert(answers.end(), own.begin(), own.end());
  }
  for (const std::vector<AnswerBits>& others : answers) EXPECT_EQ(others, answers.front());
}

// Fetch threads read pages for the real-time queries, and the blocking queries evict some of them.
TEST(Threads, BlockingAndRealTimeQueriesRunConcurrently) {
  const SampleModel sample = SampleModel::masked(octree::sphere(5));
  const std::vector<Vec3> queries = random_queries(60, -1.3, 1.3);
  std::vector<ClosestPoint> exact;
  {
    const Model model = sample.open();
    Probe probe = make_probe(model);
    for (const Vec3& query : queries) exact.push_back(probe.closest_point(query));
  }
  const Model model = sample.open(sample.min_budget(kThreads), kThreads);
  std::atomic<unsigned> waiting{kThreads / 2}, wrong{0}, degraded{0};
  const auto wait = [&] {
    Probe probe = make_probe(model);
    for (std::size_t i = 0; i < queries.size(); ++i)
      wrong += bits_of(probe.closest_point(queries[i])) != bits_of(exact[i]);
    --waiting;
  };
  const auto hurry = [&] {
    Probe probe = make_probe(model);
    do {
      for (std::size_t i = 0; i < queries.size(); ++i) {
        const ClosestPoint answer = probe.closest_point(queries[i], {.wait = Wait::kNever});
        const bool is_exact = answer.status == Status::kExact;
        degraded += !is_exact;
        wrong += is_exact ? bits_of(answer) != bits_of(exact[i])
                          : answer.lower > exact[i].upper || answer.upper < exact[i].lower;
        std::this_thread::yield();
      }
    } while (waiting > 0);
  };
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < kThreads; ++t)
    t % 2 == 0 ? threads.emplace_back(wait) : threads.emplace_back(hurry);
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(degraded, 0u);
  EXPECT_GT(model.stats().pages_evicted, 100u);
}

TEST(Threads, GetTheSameBitsInConcurrentBatches) {
  const SampleModel sample(octree::scattered(2000, 0.1));
  const std::vector<Vec3> queries = random_queries(1500, -0.2, 1.2);
  const Model model = sample.open(sample.min_budget(kThreads), kThreads);
  std::vector<std::vector<ClosestPoint>> answers(kThreads,
                                                 std::vector<ClosestPoint>(queries.size()));
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < kThreads; ++t)
    threads.emplace_back([&, t] { make_probe(model).closest_points(queries, answers[t]); });
  for (std::thread& thread : threads) thread.join();
  for (unsigned t = 1; t < kThreads; ++t)
    for (std::size_t i = 0; i < queries.size(); ++i)
      ASSERT_EQ(bits_of(answers[t][i]), bits_of(answers[0][i])) << t << ' ' << i;
}

}  // namespace
}  // namespace planetree::query
