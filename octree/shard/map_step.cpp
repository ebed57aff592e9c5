#include <utility>

#include "octree/builder/job/build_threads.h"
#include "octree/builder/job/phase_count.h"
#include "octree/builder/sort/triangle_runs.h"
#include "octree/builder/sort/triangle_spool.h"
#include "octree/builder/space_need.h"
#include "octree/geometry/strict_math.h"
#include "octree/shard/shard_steps.h"

namespace planetree::octree {
namespace {

/// Triangle indices from `first` to before `end`.
struct IndexRange {
  std::uint64_t first, end;
};

/// Passes the triangles of a range of indices on.
class SliceSink final : public TriangleSink {
 public:
  /// indices  of the model.
  /// offset   index in the model of the first triangle that this receives.
  SliceSink(const IndexRange& indices, std::uint64_t offset, TriangleSink& next,
            BuildProgress& progress)
      : indices_(indices), offset_(offset), next_(next), progress_(progress) {}

  Result<void> triangle(std::uint64_t index_in_files, const std::array<Vec3, 3>& corners) override {
    const std::uint64_t index = offset_ + index_in_files;
    if (index < indices_.first || index >= indices_.end) return {};
    ++count_;
    return next_.triangle(index, corners);
  }
  void skipped(std::uint64_t, std::uint64_t, const SkippedRecord&) override {}
  Result<void> progress(std::uint64_t bytes_done, std::uint64_t bytes_total) override {
    return progress_.progress(BuildPhase::kReading, bytes_done, bytes_total);
  }
  std::uint64_t count() const { return count_; }

 private:
  const IndexRange indices_;
  const std::uint64_t offset_;
  TriangleSink& next_;
  BuildProgress& progress_;
  std::uint64_t count_ = 0;
};

class MapStep {
 public:
  MapStep(ShardJob& job, const PlanResult& plan, std::uint32_t shard, const BuildOptions& options,
          const BuildMemory& memory, BuildProgress& progress, const BuildSeams& seams)
      : job_(job),
        plan_(plan),
        shard_(shard),
        options_(options),
        memory_(memory),
        progress_(progress),
        seams_(seams),
        path_(job.path_of(ShardKind::kSorted, shard)),
        directory_(options.spill_directory(path_)),
        mesh_(memory.reading_bytes, directory_, seams.calls),
        scratch_(directory_, 0, seams.calls),
        spool_(memory.batch_triangles, memory.spool_bytes + memory.runs_bytes, scratch_) {}

  Result<ShardReport> run() {
    if (const auto enough = check_space(); !enough) return enough.error();
    const auto triangles = read_checked();
    if (!triangles) return refuse_input(triangles.error());
    return sort(*triangles);
  }

 private:
  // Before the slice is read. It may be spilled once more than it is written.
  Result<void> check_space() {
    const ModelFrame& frame = plan_.plan.mesh.frame;
    const std::uint64_t bytes =
        Triangles::record_bytes(frame.float64) * (frame.triangle_count / plan_.plan.shards + 1);
    const SpaceNeed need{bytes <= memory_.spool_bytes ? 0 : bytes, bytes};
    BuildDirectory short_of_space = BuildDirectory::kOutput;
    const auto enough = need.check(directory_, job_.directory(), seams_.calls, short_of_space);
    if (!enough)
      progress_.failed_at(short_of_space, short_of_space == BuildDirectory::kTemporary
                                              ? directory_
                                              : job_.directory());
    return enough;
  }

  Error refuse_input(const Error& error) {
    if (scratch_.failed() || mesh_.failed())
      progress_.failed_at(BuildDirectory::kTemporary, directory_);
    else
      progress_.failed_at(BuildDirectory::kInput,
                          mesh_.file().empty() ? failed_input_ : mesh_.file());
    return error;
  }

  // Reads the files that have triangles of the part. Checks before and after the reading that they
  // are those that were planned. Returns the number of triangles.
  Result<std::uint64_t> read_checked() {
    const ShardPlan& plan = plan_.plan;
    const IndexRange part{first_of_part(shard_, plan.index_count(), plan.shards),
                          first_of_part(shard_ + 1, plan.index_count(), plan.shards)};
    const MeshFileRange files = plan.files_with(part.first, part.end);
    if (files.count == 0) return std::uint64_t{0};
    const auto before = check_files(plan, files, options_, seams_, failed_input_);
    if (!before) return before.error();
    const auto triangles = read(files, part);
    if (!triangles) return triangles;
    const auto unchanged = check_unchanged(plan, files, *before, options_, seams_, failed_input_);
    return unchanged ? triangles : unchanged.error();
  }

  Result<std::uint64_t> read(const MeshFileRange& files, const IndexRange& part) {
    SliceSink slice(part, files.first_index, spool_, progress_);
    const auto read =
        read_mesh(plan_.plan.input_of(files), slice, mesh_, {.float64 = options_.float64});
    if (!read) return read.error();
    if (const auto ended = spool_.finish_part(plan_.plan.mesh.frame); !ended) return ended.error();
    return slice.count();
  }

  // Another process may have run the same step meanwhile.
  Result<ShardReport> finished_elsewhere(const Error& error) {
    SortedRecord found;
    if (error.code != ErrorCode::kAlreadyExists) return error;
    const auto has = job_.has_sorted(plan_, shard_, found);
    if (!has || !*has) return error;
    return ShardReport{.triangles = found.triangles, .was_done = true};
  }

  Result<ShardReport> sort(std::uint64_t triangles) {
    auto file = storage::NewResultFile::create(path_, false, seams_.calls);
    if (!file) return file.error();
    storage::SpillFile data(file->file());
    TriangleRuns runs(plan_.plan.mesh.frame.float64, 0, data, storage::Packing::kGroups);
    PhaseCount count(progress_, BuildPhase::kOrdering, spool_.batch_count());
    if (const auto taken = runs.take(spool_, [&count] { return count.add(); }); !taken)
      return taken.error();
    const SortedRecord sorted{plan_.file->id(), shard_, triangles, runs.extents()};
    RecordWriter record;
    record(sorted);
    const auto done =
        file->finish(number_of(ShardKind::kSorted), data.size_bytes(), record.bytes());
    if (!done) return finished_elsewhere(done.error());
    return ShardReport{.triangles = triangles, .bytes = data.size_bytes()};
  }

  ShardJob& job_;
  const PlanResult& plan_;
  const std::uint32_t shard_;
  const BuildOptions& options_;
  const BuildMemory& memory_;
  BuildProgress& progress_;
  const BuildSeams& seams_;
  const std::filesystem::path path_;
  const std::filesystem::path directory_;
  MeshScratch mesh_;
  storage::SpillFile scratch_;
  TriangleSpool spool_;
  std::filesystem::path failed_input_;  // set by checks of the files
};

}  // namespace

Result<ShardReport> map_shard(ShardJob& job, std::uint32_t shard, BuildOptions options,
                              BuildProgress& progress, const BuildSeams& seams) {
  const auto plan = job.plan();
  if (!plan) return plan.error();
  if (const auto checked = check_shard(plan->plan, shard); !checked) return checked.error();
  plan->plan.impose_on(options);
  SortedRecord found;
  const auto has = job.has_sorted(*plan, shard, found);
  if (!has) return has.error();
  if (*has) return ShardReport{.triangles = found.triangles, .was_done = true};
  const auto memory = memory_of_step(options, seams);
  if (!memory) return memory.error();
  return BuildThreads(memory->threads).run([&] {
    return MapStep(job, *plan, shard, options, *memory, progress, seams).run();
  });
}

}  // namespace planetree::octree
