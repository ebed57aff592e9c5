#include <utility>

#include "octree/builder/job/build_threads.h"
#include "octree/builder/shared_area_sums.h"
#include "octree/builder/sort/chunks.h"
#include "octree/builder/sort/each_chunk.h"
#include "octree/builder/space_need.h"
#include "octree/builder/surface/edge_balance.h"
#include "octree/builder/surface/region_cut.h"
#include "octree/builder/tree/chunk_build.h"
#include "octree/geometry/strict_math.h"
#include "octree/shard/shard_steps.h"

namespace planetree::octree {
namespace {

/// The chunks of a shard.
struct ChunkRange {
  std::vector<Chunk> chunks;
  std::uint32_t first = 0;
  std::uint32_t total = 0;  // of the model
};

BlockShape shape_of(const OrderedMesh& mesh) {
  BlockShape shape;
  shape.float64 = mesh.frame.float64;
  shape.wide_ids = mesh.wide_ids;
  return shape;
}

class ReduceStep {
 public:
  ReduceStep(const PlanResult& plan, std::span<const SortedPart> sorted, std::uint32_t shard,
             const BuildOptions& options, BuildProgress& progress, const BuildSeams& seams)
      : plan_(plan),
        sorted_(sorted),
        shard_(shard),
        options_(options),
        progress_(progress),
        seams_(seams) {}

  Result<ShardReport> run(const std::filesystem::path& path) {
    const ModelFrame& frame = plan_.plan.mesh.frame;
    auto file = storage::NewResultFile::create(path, false, seams_.calls);
    if (!file) return file.error();
    storage::SpillFile data(file->file());
    TriangleRuns runs(frame.float64, 0, data);
    attach_runs(sorted_, data, runs);
    const auto range = range_of(runs);
    if (!range) return range.error();
    BuiltRecord built{plan_.file->id(), ids_of(sorted_), shard_, range->first, range->total, 0, {}};
    for (const Chunk& chunk : range->chunks) built.triangles += chunk.size;
    if (const auto done = build(*range, runs, data, built.results); !done) return done.error();
    RecordWriter record;
    record(built);
    const auto done = file->finish(number_of(ShardKind::kBuilt), data.size_bytes(), record.bytes());
    if (!done) return done.error();
    return ShardReport{.triangles = built.triangles,
                       .chunks = built.results.chunks.size(),
                       .bytes = data.size_bytes()};
  }

 private:
  // A chunk belongs to the shard that its first triangle is in, where triangles in Morton order are
  // divided equally.
  Result<ChunkRange> range_of(const TriangleRuns& runs) const {
    auto above = cut_chunks(runs, plan_.plan.mesh.frame.has_strays(), seams_.chunk_triangles);
    if (!above) return above.error();
    ChunkRange range{{}, 0, static_cast<std::uint32_t>(above->chunks.size())};
    std::uint64_t before = 0;
    for (Chunk& chunk : above->chunks) {
      const std::uint64_t shard = before * plan_.plan.shards / runs.size();
      before += chunk.size;
      if (shard < shard_) ++range.first;
      if (shard == shard_) range.chunks.push_back(std::move(chunk));
    }
    return range;
  }

  // `data` has the runs attached, and receives pages and edges.
  Result<void> build(const ChunkRange& range, const TriangleRuns& runs, storage::SpillFile& data,
                     ChunkResults& results) const {
    const ModelFrame& frame = plan_.plan.mesh.frame;
    const BlockShape shape = shape_of(plan_.plan.mesh);
    EdgeCensus census(0, data);
    SharedAreaSums areas(frame.core_lower(), frame.core_upper());
    RegionCut cut(frame, Region(), nullptr);
    results.chunks.resize(range.chunks.size());
    const auto build_one = [&](std::size_t i, Triangles& triangles) -> Result<void> {
      triangles.sort();
      if (const auto added = census.add(triangles); !added) return added;
      areas.add(triangles);
      if (const auto added = cut.add(triangles); !added) return added;
      auto built = build_chunk(triangles, range.total == 1, frame.centre(), shape,
                               options_.page_bytes, data);
      if (!built) return built.error();
      results.chunks[i] = *std::move(built);
      return {};
    };
    const auto built = for_each_chunk(
        runs, range.chunks, progress_, BuildPhase::kBuildingTree, [](std::size_t) { return false; },
        build_one);
    if (!built) return built;
    results.edges = census.extents();
    results.areas = areas.words();
    results.winding = cut.found().winding;
    return {};
  }

  const PlanResult& plan_;
  const std::span<const SortedPart> sorted_;
  const std::uint32_t shard_;
  const BuildOptions& options_;
  BuildProgress& progress_;
  const BuildSeams& seams_;
};

ShardReport done_before(const BuiltRecord& found) {
  return {.triangles = found.triangles, .chunks = found.results.chunks.size(), .was_done = true};
}

Result<void> check_space(const ShardPlan& plan, const ShardJob& job, BuildProgress& progress,
                         const BuildSeams& seams) {
  const ModelFrame& frame = plan.mesh.frame;
  const MeshSize size{frame.triangle_count, plan.mesh.vertex_records, frame.float64};
  const SpaceNeed need{0, SpaceNeed::raw_page_bytes(size) / plan.shards};
  BuildDirectory directory = BuildDirectory::kOutput;
  const auto enough = need.check(job.directory(), job.directory(), seams.calls, directory);
  if (!enough) progress.failed_at(directory, job.directory());
  return enough;
}

}  // namespace

Result<ShardReport> reduce_shard(ShardJob& job, std::uint32_t shard, BuildOptions options,
                                 BuildProgress& progress, const BuildSeams& seams) {
  const auto plan = job.plan();
  if (!plan) return plan.error();
  if (const auto checked = check_shard(plan->plan, shard); !checked) return checked.error();
  plan->plan.impose_on(options);
  const auto sorted = job.sorted(*plan);
  if (!sorted) return sorted.error();
  BuiltRecord found;
  const auto has = job.has_built(*plan, *sorted, shard, found);
  if (!has) return has.error();
  if (*has) return done_before(found);
  const auto memory = memory_of_step(options, seams);
  if (!memory) return memory.error();
  if (const auto enough = check_space(plan->plan, job, progress, seams); !enough)
    return enough.error();
  const auto report = BuildThreads(memory->threads).run([&] {
    return ReduceStep(*plan, *sorted, shard, options, progress, seams)
        .run(job.path_of(ShardKind::kBuilt, shard));
  });
  // Another process may have run the same step meanwhile.
  if (report || report.error().code != ErrorCode::kAlreadyExists) return report;
  const auto elsewhere = job.has_built(*plan, *sorted, shard, found);
  return elsewhere && *elsewhere ? done_before(found) : report;
}

}  // namespace planetree::octree
