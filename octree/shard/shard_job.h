#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "octree/builder/build_seams.h"
#include "octree/builder/shard_results.h"
#include "octree/shard/shard_plan.h"
#include "planetree/error.h"
#include "storage/file/checksum.h"
#include "storage/spill/result_file.h"

namespace planetree::octree {

/// Kinds of result files.
enum class ShardKind : std::uint32_t { kPlan = 1, kSorted = 2, kBuilt = 3 };

/// Number of a kind in a file, which differs between releases.
std::uint64_t number_of(ShardKind kind);

/// A plan and the file it is in.
struct PlanResult {
  ResultFilePointer file;
  ShardPlan plan;
};

/// Record of a part of the triangles.
struct SortedRecord {
  storage::Hash128 plan{};  ///< id
  std::uint32_t shard = 0;
  std::uint64_t triangles = 0;
  std::vector<TriangleRuns::Extent> runs;
};

/// Record of a stretch of chunks.
struct BuiltRecord {
  storage::Hash128 plan{};            ///< id
  std::vector<std::uint64_t> sorted;  ///< ids of all parts, low and high halves in turn
  std::uint32_t shard = 0;
  std::uint32_t first_chunk = 0;
  std::uint32_t chunk_count = 0;  ///< of the model
  std::uint64_t triangles = 0;
  ChunkResults results;
};

/// The directory of a sharded build: one file for each result. No file is ever changed; a file that
/// an out-of-date step left is removed before the step is repeated.
///
/// threads  one at a time in one process; any number of processes, on any machines that share the
///          directory.
class ShardJob {
 public:
  /// seams  must outlive this.
  ShardJob(std::filesystem::path directory, const BuildSeams& seams)
      : directory_(std::move(directory)), seams_(seams) {}

  const std::filesystem::path& directory() const { return directory_; }
  std::filesystem::path path_of(ShardKind kind, std::uint32_t shard = 0) const;
  /// The file that the last error of a call concerns.
  const std::filesystem::path& failed_at() const { return failed_at_; }

  /// errors  kNotFound: there is none; what to do is in the text; those of ResultFile::open().
  Result<PlanResult> plan();
  /// The results of all steps of a kind, which must be those of the plan, and of each other.
  /// errors  kNotFound: a step was not run yet; kBadInput: it was run with another plan or other
  ///         parts. The text says which step to run. Those of ResultFile::open().
  Result<std::vector<SortedPart>> sorted(const PlanResult& plan);
  Result<std::vector<BuiltPart>> built(const PlanResult& plan, std::span<const SortedPart> sorted);

  /// Whether a step was run already with these inputs. Removes a result that is broken or was made
  /// from others.
  /// errors  those of reading it and of unlink(2).
  Result<bool> has_sorted(const PlanResult& plan, std::uint32_t shard, SortedRecord& found);
  Result<bool> has_built(const PlanResult& plan, std::span<const SortedPart> sorted,
                         std::uint32_t shard, BuiltRecord& found);

 private:
  Result<void> remove(ShardKind kind, std::uint32_t shard);
  Result<bool> remove_old(const Result<ResultFilePointer>& file, ShardKind kind,
                          std::uint32_t shard);
  template <class Value>
  Result<ResultFilePointer> open(ShardKind kind, std::uint32_t shard, Value& record);
  Error step_missing(ShardKind kind, std::uint32_t shard, const Error& error) const;
  Error step_stale(ShardKind kind, std::uint32_t shard) const;

  const std::filesystem::path directory_;
  const BuildSeams& seams_;
  std::filesystem::path failed_at_;
};

/// Ids of files, low and high halves in turn.
std::vector<std::uint64_t> ids_of(std::span<const SortedPart> parts);

template <class Record, IsA<ChunkResults> Value>
void fields(Record& record, Value& results) {
  record(results.chunks, results.edges, results.areas, results.winding);
}

template <class Record, IsA<SortedRecord> Value>
void fields(Record& record, Value& part) {
  record(part.plan.low, part.plan.high, part.shard, part.triangles, part.runs);
}

template <class Record, IsA<BuiltRecord> Value>
void fields(Record& record, Value& part) {
  record(part.plan.low, part.plan.high, part.sorted, part.shard, part.first_chunk, part.chunk_count,
         part.triangles, part.results);
}

}  // namespace planetree::octree
