#pragma once

#include <cstdint>
#include <filesystem>

#include "octree/builder/build_seams.h"
#include "octree/builder/job/build_options.h"
#include "octree/builder/job/build_progress.h"
#include "octree/builder/tree_builder.h"
#include "octree/shard/shard_job.h"
#include "planetree/error.h"
#include "planetree/shard.h"

/// The steps of a sharded build. Each leaves one file, complete or not at all. A step whose result
/// is there already does nothing. Arguments are as in planetree/shard.h.
///
/// errors   as in planetree/shard.h.
/// threads  one step at a time on a ShardJob; each uses oneTBB on options.threads threads.
namespace planetree::octree {

/// input  one or more files.
Result<ShardPlanReport> plan_shards(const BuildInput& input, ShardJob& job, std::uint32_t shards,
                                    const BuildOptions& options, BuildProgress& progress,
                                    const BuildSeams& seams = {});

Result<ShardReport> map_shard(ShardJob& job, std::uint32_t shard, BuildOptions options,
                              BuildProgress& progress, const BuildSeams& seams = {});

Result<ShardReport> reduce_shard(ShardJob& job, std::uint32_t shard, BuildOptions options,
                                 BuildProgress& progress, const BuildSeams& seams = {});

Result<BuildReport> merge_shards(ShardJob& job, const std::filesystem::path& output,
                                 BuildOptions options, BuildProgress& progress,
                                 const BuildSeams& seams = {});

/// The memory of a step.
/// errors  those of BuildMemory::share().
Result<BuildMemory> memory_of_step(const BuildOptions& options, const BuildSeams& seams);

/// errors  kBadArgument: the plan has no such shard.
Result<void> check_shard(const ShardPlan& plan, std::uint32_t shard);

}  // namespace planetree::octree
