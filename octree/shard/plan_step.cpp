#include <sys/stat.h>

#include <cerrno>
#include <utility>

#include "octree/builder/build_identity.h"
#include "octree/builder/job/build_memory.h"
#include "octree/builder/job/input_paths.h"
#include "octree/builder/sort/frame_finder.h"
#include "octree/builder/sort/frame_sink.h"
#include "octree/builder/sort/triangles.h"
#include "octree/builder/space_need.h"
#include "octree/geometry/strict_math.h"
#include "octree/shard/shard_steps.h"
#include "storage/system/file_error.h"

namespace planetree::octree {
namespace {

/// Receives triangles for a CoreFinder.
class CoreSink final : public TriangleSink {
 public:
  explicit CoreSink(CoreFinder& finder) : finder_(finder) {}
  Result<void> triangle(std::uint64_t, const std::array<Vec3, 3>& corners) override {
    finder_.add(triangle_of(corners));
    return {};
  }
  void skipped(std::uint64_t, std::uint64_t, const SkippedRecord&) override {}
  Result<void> progress(std::uint64_t, std::uint64_t) override { return {}; }

 private:
  CoreFinder& finder_;
};

/// Finds the frame of a mesh without keeping its triangles. Reads the mesh again if some of them
/// may be stray.
class FrameReading final : public FrameSink {
 public:
  FrameReading(const BuildInput& input, const MeshOptions& how, MeshScratch& scratch)
      : input_(input), how_(how), scratch_(scratch) {}

  Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) override {
    finder_.add(index, corners);
    return {};
  }
  void skipped(std::uint64_t first_index, std::uint64_t count, const SkippedRecord& why) override {
    finder_.skip(first_index, count, why);
  }
  Result<ModelFrame> finish() override {
    CoreFinder core = finder_.core_finder();
    if (core.may_have_strays()) {
      CoreSink sink(core);
      if (const auto read = read_mesh(input_, sink, scratch_, how_); !read) return read.error();
    }
    return finder_.found(core.found());
  }

 private:
  const BuildInput& input_;
  const MeshOptions how_;
  MeshScratch& scratch_;
  FrameFinder finder_;
};

Result<void> make_directory(const std::filesystem::path& path, storage::FileCalls& calls) {
  constexpr mode_t kMode = 0777;  // the system subtracts the umask
  if (calls.mkdirat(AT_FDCWD, path.c_str(), kMode) == 0 || errno == EEXIST) return {};
  return storage::file_error(errno, storage::FileAction::kWrite, "create the directory of the job");
}

// Of sorted triangles and of raw pages. What a step writes is 1/shards of it.
ShardPlanReport report_of(const PlanResult& found, bool was_done) {
  const ShardPlan& plan = found.plan;
  ShardPlanReport report;
  report.shards = plan.shards;
  report.triangles = plan.mesh.frame.triangle_count;
  report.skipped = plan.mesh.frame.skipped_count;
  report.input_bytes = plan.identity.input_bytes();
  report.plan_bytes = found.file->data_bytes();
  report.sorted_bytes = report.triangles * Triangles::record_bytes(plan.mesh.frame.float64);
  const MeshSize size{report.triangles, plan.mesh.vertex_records, plan.mesh.frame.float64};
  report.built_bytes = SpaceNeed::raw_page_bytes(size);
  report.was_done = was_done;
  return report;
}

/// Reads the mesh and stores the plan.
class PlanStep {
 public:
  PlanStep(const BuildInput& input, const BuildOptions& options, const BuildMemory& memory,
           const std::filesystem::path& plan_path, BuildProgress& progress, const BuildSeams& seams)
      : input_(input),
        options_(options),
        directory_(options.spill_directory(plan_path)),
        scratch_(memory.reading_bytes, directory_, seams.calls),
        progress_(progress),
        seams_(seams) {}

  // plan  of an input of this identity.
  Result<void> run(ShardPlan& plan, storage::NewResultFile& file) {
    storage::SpillFile kept(file.file());
    if (const auto read_all = read(plan, kept); !read_all) {
      const bool temporary = scratch_.failed();
      if (!kept.failed())
        progress_.failed_at(temporary ? BuildDirectory::kTemporary : BuildDirectory::kInput,
                            temporary ? directory_ : failed_input());
      return read_all;
    }
    RecordWriter record;
    record(plan);
    const auto done = file.finish(number_of(ShardKind::kPlan), kept.size_bytes(), record.bytes());
    return done ? Result<void>() : done.error();
  }

 private:
  Result<void> read(ShardPlan& plan, storage::SpillFile& kept) {
    FrameReading frame(input_, {.float64 = options_.float64}, scratch_);
    auto mesh = read_unordered(input_, options_, scratch_, progress_, frame, kept);
    if (!mesh) return mesh.error();
    plan.mesh = *std::move(mesh);
    for (const std::filesystem::path& path : paths_of(input_)) {
      const auto content = content_of(path, seams_.calls);
      if (!content) failed_input_ = path;
      if (!content) return content.error();
      plan.contents.push_back(*content);
    }
    return check_unchanged(plan, plan.all_files(), plan.identity.inputs, options_, seams_,
                           failed_input_);
  }
  std::filesystem::path failed_input() const {
    if (!scratch_.file().empty()) return scratch_.file();
    return failed_input_.empty() ? path_of(input_) : failed_input_;
  }

  const BuildInput& input_;
  const BuildOptions& options_;
  const std::filesystem::path directory_;
  MeshScratch scratch_;
  BuildProgress& progress_;
  const BuildSeams& seams_;
  std::filesystem::path failed_input_;  // set by what follows the reading
};

}  // namespace

Result<void> check_shard(const ShardPlan& plan, std::uint32_t shard) {
  if (shard < plan.shards) return {};
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "there is no shard %u; the plan has %u, from 0 to %u", shard, plan.shards,
                    plan.shards - 1);
}

Result<BuildMemory> memory_of_step(const BuildOptions& options, const BuildSeams& seams) {
  return seams.memory ? Result<BuildMemory>(*seams.memory)
                      : BuildMemory::share(options.memory_bytes, options.threads);
}

Result<ShardPlanReport> plan_shards(const BuildInput& input, ShardJob& job, std::uint32_t shards,
                                    const BuildOptions& options, BuildProgress& progress,
                                    const BuildSeams& seams) {
  const auto memory = memory_of_step(options, seams);
  if (!memory) return memory.error();
  std::filesystem::path failed_at = path_of(input);
  const auto identity = BuildIdentity::of(input, options, seams, &failed_at);
  if (!identity) {
    progress.failed_at(BuildDirectory::kInput, failed_at);
    return identity.error();
  }
  ShardPlan plan = ShardPlan::of(input, shards, *identity, options);
  const auto earlier = job.plan();
  if (earlier && earlier->plan.is_like(plan)) return report_of(*earlier, true);
  if (const auto made = make_directory(job.directory(), seams.calls); !made) return made.error();
  const auto plan_path = job.path_of(ShardKind::kPlan);
  auto file = storage::NewResultFile::create(plan_path, true, seams.calls);
  if (!file) return file.error();
  PlanStep step(input, options, *memory, plan_path, progress, seams);
  if (const auto done = step.run(plan, *file); !done) return done.error();
  const auto found = job.plan();
  return found ? Result<ShardPlanReport>(report_of(*found, false)) : found.error();
}

}  // namespace planetree::octree
