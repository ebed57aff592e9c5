#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "octree/shard/shard_steps.h"
#include "tests/octree/builder/build_fixture.h"
#include "tests/octree/builder/resumed_build.h"
#include "tests/storage/system/faulty_calls.h"

namespace planetree::octree {

/// Builds by the steps of a job, beside builds in one process.
class ShardedBuild : public SmallChunks {
 protected:
  ShardedBuild() {
    options_.page_bytes = 4096;
    options_.replace = true;
  }

  BuildSeams seams(storage::FileCalls& calls) const { return {40, 60, memory_, calls}; }
  // The bytes that a build in one process writes.
  storage::Bytes whole() {
    recorder_ = {};
    const auto report = build_tree(input(), output_, options_, recorder_, seams(idle_));
    EXPECT_TRUE(report) << report.error().text;
    storage::Bytes bytes = built();
    std::filesystem::remove(output_);
    return bytes;
  }
  Result<ShardPlanReport> plan(std::uint32_t shards) { return plan(shards, idle_); }
  Result<ShardPlanReport> plan(std::uint32_t shards, storage::FileCalls& calls) {
    recorder_ = {};
    const BuildSeams with = seams(calls);
    ShardJob job(job_, with);
    return plan_shards(input(), job, shards, options_, recorder_, with);
  }
  Result<ShardReport> map(std::uint32_t shard) { return map(shard, idle_); }
  Result<ShardReport> map(std::uint32_t shard, storage::FileCalls& calls) {
    recorder_ = {};
    const BuildSeams with = seams(calls);
    ShardJob job(job_, with);
    return map_shard(job, shard, BuildOptions(), recorder_, with);
  }
  Result<ShardReport> reduce(std::uint32_t shard) { return reduce(shard, idle_); }
  Result<ShardReport> reduce(std::uint32_t shard, storage::FileCalls& calls) {
    recorder_ = {};
    const BuildSeams with = seams(calls);
    ShardJob job(job_, with);
    return reduce_shard(job, shard, BuildOptions(), recorder_, with);
  }
  Result<BuildReport> merge() { return merge(idle_); }
  Result<BuildReport> merge(storage::FileCalls& calls) {
    recorder_ = {};
    const BuildSeams with = seams(calls);
    ShardJob job(job_, with);
    BuildOptions options;
    options.replace = true;
    return merge_shards(job, output_, options, recorder_, with);
  }
  void run_all(std::uint32_t shards) {
    const auto planned = plan(shards);
    ASSERT_TRUE(planned) << planned.error().text;
    run_all_after_plan(shards);
  }
  void run_all_after_plan(std::uint32_t shards) {
    // The last ones first: no step depends on another of its kind.
    for (std::uint32_t i = shards; i-- > 0;) {
      const auto done = map(i);
      ASSERT_TRUE(done) << done.error().text;
    }
    for (std::uint32_t i = shards; i-- > 0;) {
      const auto done = reduce(i);
      ASSERT_TRUE(done) << done.error().text;
    }
    const auto merged = merge();
    ASSERT_TRUE(merged) << merged.error().text;
  }
  void expect_same(std::initializer_list<std::uint32_t> counts = {1, 2, 3, 7}) {
    const storage::Bytes expected = whole();
    for (const std::uint32_t shards : counts) {
      SCOPED_TRACE(std::to_string(shards) + " shards");
      std::filesystem::remove_all(job_);
      run_all(shards);
      ASSERT_EQ(built(), expected);
    }
  }
  std::filesystem::path file_of(ShardKind kind, std::uint32_t shard) const {
    return job_ / ((kind == ShardKind::kSorted ? "map-" : "reduce-") + std::to_string(shard));
  }

  storage::FaultyCalls idle_;  // do not fail, and do not wait for the disk
  BuildOptions options_;
  BuildMemory memory_ = kTight;
  const std::filesystem::path job_ = folder_ / "job";
  BuildRecorder recorder_;
};

}  // namespace planetree::octree
