#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "planetree/build.h"
#include "planetree/error.h"
#include "planetree/export.h"

/// @file
/// Building one .ptree file by many processes, on one machine or on many that share a directory:
/// the job. A scheduler of the caller runs the steps. Each step reads files of the job and leaves
/// one, complete or not at all, so that it can be killed at any time, and run again, anywhere.
///
///     plan_shards()   once: reads the mesh, of one file or several
///     map_shard()     for each shard, in any order: sorts a part of the triangles
///     reduce_shard()  for each shard, after all of map_shard(): builds a part of the tree
///     merge_shards()  once, after all of reduce_shard(): writes the file
///
/// The file has the bytes that build() writes from the same mesh with the same options, whatever
/// the number of shards. A step whose result is there already does nothing. A result names the
/// results that it was made from, so that none of an earlier plan is taken: a step returns an error
/// that says which step to run again.
///
/// Of BuildOptions, plan_shards() keeps those that the bytes of the file depend on. The other steps
/// use `threads`, `memory_bytes`, `temp_directory`, `replace` and the callbacks, and ignore the
/// rest. Temporary files are in the job's directory unless `temp_directory` is set.
///
/// The job's files have the byte order of the machine, and are read by the same release of
/// planetree only. Remove the directory when the output is complete.

namespace planetree {

/// What was planned.
struct ShardPlanReport {
  std::uint32_t shards = 0;        ///< number of shards of the job
  std::uint64_t triangles = 0;     ///< usable triangles of the mesh
  std::uint64_t skipped = 0;       ///< triangle indices of skipped records
  std::uint64_t input_bytes = 0;   ///< length of the mesh files
  std::uint64_t plan_bytes = 0;    ///< attributes that the plan keeps
  std::uint64_t sorted_bytes = 0;  ///< maximum length of all results of map_shard()
  std::uint64_t built_bytes = 0;   ///< estimate of the length of all results of reduce_shard()
  bool was_done = false;           ///< the job was planned like this already
};

/// What a step did.
struct ShardReport {
  std::uint64_t triangles = 0;  ///< triangles of the shard
  std::uint64_t chunks = 0;     ///< chunks that were built; 0 of map_shard()
  std::uint64_t bytes = 0;      ///< data that the step wrote; 0 if it had nothing to do
  bool was_done = false;        ///< the result was there already
};

/// Most shards of a job.
inline constexpr std::uint32_t kMaxShards = 16384;

/// Reads a mesh and plans its build.
///
/// input    a mesh file, as for BuildInput. All machines that run map_shard() find it, or a copy
///          with the same bytes, under the same path.
/// job      directory of the job; is created if it does not exist. An earlier plan in it is
///          replaced if the input, the options or `shards` differ.
/// shards   1 to kMaxShards.
/// options  without `box` and `resume`.
/// errors   as those of build() for the input and the options; kBadArgument also for `shards`,
///          `box` and `resume`; those of writing the plan.
/// threads  as build().
[[nodiscard]] PLANETREE_API Result<ShardPlanReport> plan_shards(const std::filesystem::path& input,
                                                                const std::filesystem::path& job,
                                                                std::uint32_t shards,
                                                                const BuildOptions& options = {});

/// As above, of mesh files that together are one mesh, as for BuildInput. map_shard() reads only
/// the files that have triangles of its part.
///
/// inputs  at least one path.
[[nodiscard]] PLANETREE_API Result<ShardPlanReport> plan_shards(
    const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& job,
    std::uint32_t shards, const BuildOptions& options = {});

/// Sorts one of `shards` parts of the triangles, by Morton code.
///
/// shard    from 0.
/// errors   as those of build(); kBadInput: the mesh is not the one that was planned, or the plan
///          is none of this release; kNotFound: there is no plan; kBadArgument: no such shard;
///          kDamaged, kTruncated: a file of the job is not what was written.
/// threads  as build().
[[nodiscard]] PLANETREE_API Result<ShardReport> map_shard(const std::filesystem::path& job,
                                                          std::uint32_t shard,
                                                          const BuildOptions& options = {});

/// Builds one of `shards` stretches of the tree. Does not read the mesh.
///
/// errors  as those of map_shard(); kNotFound, kBadInput: a step of map_shard() is to be run, which
///         the text names.
[[nodiscard]] PLANETREE_API Result<ShardReport> reduce_shard(const std::filesystem::path& job,
                                                             std::uint32_t shard,
                                                             const BuildOptions& options = {});

/// Joins all parts and writes the file. Does not read the mesh.
///
/// output  as for build().
/// errors  as those of reduce_shard() and, of the output, build().
/// return  as build(). BuildReport::notes are those of the plan.
[[nodiscard]] PLANETREE_API Result<BuildReport> merge_shards(const std::filesystem::path& job,
                                                             const std::filesystem::path& output,
                                                             const BuildOptions& options = {});

}  // namespace planetree
