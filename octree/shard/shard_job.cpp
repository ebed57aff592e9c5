#include "octree/shard/shard_job.h"

#include <fcntl.h>

#include <cerrno>
#include <numeric>
#include <string>
#include <utility>

#include "octree/builder/surface/edge_balance.h"
#include "storage/system/file_error.h"

namespace planetree::octree {
namespace {

constexpr const char* kNames[] = {"", "plan", "map", "reduce"};

const char* step_of(ShardKind kind) { return kNames[static_cast<std::uint32_t>(kind)]; }

std::string step_command(ShardKind kind, std::uint32_t shard) {
  return std::string("'planetree shard ") + step_of(kind) + " JOB " + std::to_string(shard) + "'";
}

Error damaged_record() {
  return make_error(ErrorCode::kDamaged, Error::kNowhere, Error::kNowhere,
                    "the record does not fit the file; remove the file and repeat the step");
}

// Whether there is one of everything for each file of the input.
bool fits_files(const ShardPlan& plan) {
  const std::size_t count = plan.inputs.size();
  const auto& indices = plan.mesh.file_indices;
  return count > 0 && plan.identity.inputs.size() == count && plan.contents.size() == count &&
         indices.size() == count &&
         std::accumulate(indices.begin(), indices.end(), std::uint64_t{0}) == plan.index_count();
}

bool fits(const ShardPlan& plan, std::uint64_t data_bytes) {
  SpillExtent extent(data_bytes);
  return fits_files(plan) && plan.shards > 0 && plan.mesh.frame.triangle_count > 0 &&
         plan.mesh.runs.empty() && plan.mesh.value_kind <= ValueKind::kReal &&
         extent.take(plan.mesh.attributes, plan.index_count());
}

bool fits(const SortedRecord& part, const ShardPlan& plan, std::uint64_t data_bytes) {
  return SpillExtent(data_bytes).take(part.runs, part.triangles, plan.mesh.frame.float64);
}

bool fits(const BuiltRecord& part, std::uint64_t data_bytes) {
  SpillExtent extent(data_bytes);
  if (!extent.take(part.results.edges, EdgeCensus::kEdgeBytes)) return false;
  for (const BuiltChunk& chunk : part.results.chunks)
    if (!extent.take(chunk)) return false;
  return true;
}

}  // namespace

std::uint64_t number_of(ShardKind kind) {
  const std::string version = work_version();
  return storage::hash64(std::as_bytes(std::span(version)), static_cast<std::uint64_t>(kind));
}

std::filesystem::path ShardJob::path_of(ShardKind kind, std::uint32_t shard) const {
  const std::string name = step_of(kind);
  return directory_ / (kind == ShardKind::kPlan ? name : name + '-' + std::to_string(shard));
}

template <class Value>
Result<ResultFilePointer> ShardJob::open(ShardKind kind, std::uint32_t shard, Value& value) {
  failed_at_ = path_of(kind, shard);
  auto file = storage::ResultFile::open(failed_at_, number_of(kind), seams_.calls);
  if (!file) return file.error();
  RecordReader record(file->record());
  record(value);
  if (!record.fits()) return damaged_record();
  return std::make_shared<const storage::ResultFile>(*std::move(file));
}

Result<PlanResult> ShardJob::plan() {
  PlanResult found;
  auto file = open(ShardKind::kPlan, 0, found.plan);
  if (!file && file.error().code == ErrorCode::kNotFound)
    return make_error(ErrorCode::kNotFound, Error::kNowhere, Error::kNowhere,
                      "no plan; run 'planetree shard plan MESH -o JOB --shards N' first");
  if (!file) return file.error();
  found.file = *std::move(file);
  if (!fits(found.plan, found.file->data_bytes())) return damaged_record();
  return found;
}

Error ShardJob::step_missing(ShardKind kind, std::uint32_t shard, const Error& error) const {
  if (error.code != ErrorCode::kNotFound) return error;
  return make_error(ErrorCode::kNotFound, Error::kNowhere, Error::kNowhere,
                    "the step was not run yet; run %s first", step_command(kind, shard).c_str());
}

Error ShardJob::step_stale(ShardKind kind, std::uint32_t shard) const {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "made from other results than there are now; run %s again",
                    step_command(kind, shard).c_str());
}

Result<std::vector<SortedPart>> ShardJob::sorted(const PlanResult& plan) {
  std::vector<SortedPart> parts;
  std::uint64_t triangles = 0;
  for (std::uint32_t shard = 0; shard < plan.plan.shards; ++shard) {
    SortedRecord record;
    auto file = open(ShardKind::kSorted, shard, record);
    if (!file) return step_missing(ShardKind::kSorted, shard, file.error());
    if (record.plan != plan.file->id() || record.shard != shard)
      return step_stale(ShardKind::kSorted, shard);
    if (!fits(record, plan.plan, (*file)->data_bytes())) return damaged_record();
    triangles += record.triangles;
    parts.push_back({*std::move(file), std::move(record.runs)});
  }
  if (triangles != plan.plan.mesh.frame.triangle_count) return damaged_record();
  return parts;
}

Result<std::vector<BuiltPart>> ShardJob::built(const PlanResult& plan,
                                               std::span<const SortedPart> sorted) {
  const std::vector<std::uint64_t> ids = ids_of(sorted);
  std::vector<BuiltPart> parts;
  std::uint64_t chunks = 0, chunk_count = 0;
  for (std::uint32_t shard = 0; shard < plan.plan.shards; ++shard) {
    BuiltRecord record;
    auto file = open(ShardKind::kBuilt, shard, record);
    if (!file) return step_missing(ShardKind::kBuilt, shard, file.error());
    if (record.plan != plan.file->id() || record.shard != shard || record.sorted != ids)
      return step_stale(ShardKind::kBuilt, shard);
    if (record.first_chunk != chunks || !fits(record, (*file)->data_bytes()))
      return damaged_record();
    chunks += record.results.chunks.size();
    chunk_count = record.chunk_count;
    parts.push_back({*std::move(file), std::move(record.results)});
  }
  if (chunks != chunk_count) return damaged_record();
  return parts;
}

Result<bool> ShardJob::has_sorted(const PlanResult& plan, std::uint32_t shard,
                                  SortedRecord& found) {
  const auto file = open(ShardKind::kSorted, shard, found);
  const bool good = file && found.plan == plan.file->id() && found.shard == shard &&
                    fits(found, plan.plan, (*file)->data_bytes());
  return good ? Result<bool>(true) : remove_old(file, ShardKind::kSorted, shard);
}

Result<bool> ShardJob::has_built(const PlanResult& plan, std::span<const SortedPart> sorted,
                                 std::uint32_t shard, BuiltRecord& found) {
  const auto file = open(ShardKind::kBuilt, shard, found);
  const bool good = file && found.plan == plan.file->id() && found.shard == shard &&
                    found.sorted == ids_of(sorted) && fits(found, (*file)->data_bytes());
  return good ? Result<bool>(true) : remove_old(file, ShardKind::kBuilt, shard);
}

// Returns false if the name is free now.
Result<bool> ShardJob::remove_old(const Result<ResultFilePointer>& file, ShardKind kind,
                                  std::uint32_t shard) {
  if (!file) {
    const ErrorCode code = file.error().code;
    if (code == ErrorCode::kNotFound) return false;
    const bool is_broken = code == ErrorCode::kDamaged || code == ErrorCode::kTruncated ||
                           code == ErrorCode::kBadInput;
    if (!is_broken) return file.error();
  }
  const auto removed = remove(kind, shard);
  return removed ? Result<bool>(false) : removed.error();
}

Result<void> ShardJob::remove(ShardKind kind, std::uint32_t shard) {
  failed_at_ = path_of(kind, shard);
  if (seams_.calls.unlinkat(AT_FDCWD, failed_at_.c_str(), 0) == 0 || errno == ENOENT) return {};
  return storage::file_error(errno, storage::FileAction::kWrite, "remove an out-of-date result");
}

std::vector<std::uint64_t> ids_of(std::span<const SortedPart> parts) {
  std::vector<std::uint64_t> ids;
  for (const SortedPart& part : parts) {
    ids.push_back(part.file->id().low);
    ids.push_back(part.file->id().high);
  }
  return ids;
}

}  // namespace planetree::octree
