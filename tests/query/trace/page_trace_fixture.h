#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <vector>

#include "planetree/probe.h"
#include "query/model_state.h"
#include "tests/query/fetch_steps.h"
#include "tests/query/sample_model.h"

namespace planetree::query {

/// A model whose page trace a test drains, without threads or clocks.
class PageTraceTest : public testing::Test {
 protected:
  static constexpr std::uint32_t kCapacity = 1 << 13;

  // A clock that goes on by a nanosecond whenever it is read.
  static std::uint64_t count_readings(const void* readings) noexcept {
    return ++*static_cast<std::uint64_t*>(const_cast<void*>(readings));
  }

  PageTraceTest() : sample_(SampleModel::masked(octree::sphere(5))) {}

  Model open(std::uint32_t page_trace_capacity,
             std::uint64_t budget_bytes = std::uint64_t{64} << 20) {
    OpenOptions options;
    options.max_probes = 2;  // one of them for the worker
    options.memory_budget_bytes = budget_bytes;
    options.page_trace_capacity = page_trace_capacity;
    ModelSeams seams{storage::FileCalls::real(), false};
    readings_ = 0;
    seams.trace_time = {&count_readings, &readings_};
    auto model = ModelState::open_model(sample_.path(), options, seams);
    EXPECT_TRUE(model);
    return *std::move(model);
  }
  // The budget of the fewest frames, or of so many more.
  Model open_small(std::uint64_t more_frames = 0) {
    OpenOptions options;
    options.max_probes = 2;
    options.page_trace_capacity = kCapacity;
    const auto least = ModelState::min_budget_bytes(sample_.path(), options);
    EXPECT_TRUE(least);
    return open(kCapacity, *least + more_frames * 4096);
  }

  FetchWorker worker_of(const Model& model) const {
    return fetch_worker(
        ModelState::of(model), [] { return FetchWorker::Seconds(0); }, never_);
  }

  static std::vector<PageAccess> take_all(const Model& model) {
    std::vector<PageAccess> all(1 << 16);
    all.resize(model.drain_page_trace(all));
    return all;
  }
  // Without what Model::open did.
  static std::vector<PageAccess> take_queries(const Model& model) {
    std::vector<PageAccess> all = take_all(model);
    std::erase_if(all, [](const PageAccess& access) {
      return access.query_kind == PageAccess::Query::kOpen;
    });
    return all;
  }

  static ClosestPoint real_time_answer(Probe& probe, const Vec3& point) {
    return probe.closest_point(point, {.wait = Wait::kNever});
  }

  // Moves a probe and queries, while a worker fetches the pages that it misses and those along its
  // motion.
  std::vector<PageAccess> wander(const Model& model) {
    FetchWorker worker = worker_of(model);
    Probe probe = make_probe(model);
    std::vector<PageAccess> all = take_all(model);
    for (const Vec3& point : random_queries(200, -1.2, 1.2, 3)) {
      probe.motion(point, {point.y, point.z, point.x});
      (void)real_time_answer(probe, point);
      for (int actions = 0; actions < 3; ++actions) worker.work();
      const std::vector<PageAccess> taken = take_all(model);
      all.insert(all.end(), taken.begin(), taken.end());
    }
    EXPECT_EQ(model.stats().page_trace_dropped, 0u);
    return all;
  }
  SampleModel sample_;
  const std::atomic<bool> never_{false};
  std::uint64_t readings_ = 0;
};

}  // namespace planetree::query
