#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "octree/builder/build_files.h"
#include "octree/builder/build_seams.h"
#include "octree/builder/cap_tree.h"
#include "octree/builder/job/build_memory.h"
#include "octree/builder/job/build_options.h"
#include "octree/builder/job/build_progress.h"
#include "octree/builder/mask/mask_sectors.h"
#include "octree/builder/mesh/mesh_size.h"
#include "octree/builder/shard_results.h"
#include "octree/builder/sort/ordered_mesh.h"
#include "octree/builder/sort/triangle_runs.h"
#include "octree/builder/tree/built_tree.h"
#include "octree/builder/tree_builder.h"
#include "octree/builder/tree_file.h"
#include "planetree/build.h"
#include "planetree/error.h"

namespace planetree::octree {

/// One build, step by step.
///
/// threads  one at a time; run() and join() use the calling thread's TBB arena.
class TreeBuild {
 public:
  /// All arguments but `memory` must outlive this.
  TreeBuild(const BuildInput& input, const std::filesystem::path& output,
            const BuildOptions& options, const BuildMemory& memory, BuildProgress& progress,
            const BuildSeams& seams)
      : input_(input),
        output_(output),
        options_(options),
        memory_(memory),
        progress_(progress),
        seams_(seams),
        files_(output, options, memory, seams.calls) {}

  /// Does all steps.
  Result<BuildReport> run();
  /// Does the steps that are left when other processes have done the rest.
  /// results  all of one plan; must outlive this.
  Result<BuildReport> join(const ShardResults& results);

  /// Reports where an error of run() or join() comes from.
  void report_failure() const;

 private:
  std::filesystem::path failed_input() const;
  Result<void> resume_work();
  Result<void> estimate_size();
  Result<void> estimate_unpacked(const MeshFile& content);
  Result<void> check_space(const MeshSize& size);
  Result<void> order_triangles();
  Result<void> read();
  Result<void> resume_mesh();
  Result<void> set_mesh(const OrderedMesh& mesh, std::uint64_t kept_bytes, bool matched);
  Region region() const { return model_.box ? model_.box->region(model_.frame) : Region(); }
  Result<void> look_at_surface();
  Result<void> match_edges();
  void take_whole_surface();
  Result<void> cut_out_part();
  Result<void> divide_sectors();
  Result<void> build_chunks();
  void resume_chunks();
  Result<void> build(std::size_t number, Triangles& triangles);
  Result<void> number_pages();
  Result<void> colour_cells();
  Result<BuildReport> write_pages();
  Result<BuildReport> finish();
  // In tree_join.cpp.
  Result<void> join_triangles(const ShardResults& results);
  Result<void> join_surface(const std::vector<BuiltPart>& parts);
  Result<void> join_chunks(const std::vector<BuiltPart>& parts);
  /// The triangles to be built.
  const TriangleRuns& runs() const { return part_ ? *part_ : *whole_; }
  template <class... Parts>
  Result<void> keep(const Parts&... parts) {
    return files_.work() ? files_.work()->keep(parts...) : Result<void>();
  }

  const BuildInput& input_;
  const std::filesystem::path& output_;
  const BuildOptions& options_;
  const BuildMemory memory_;
  BuildProgress& progress_;
  const BuildSeams& seams_;
  bool writing_ = false;
  std::filesystem::path failed_input_;  // of several, the one that could not be examined
  BuildFiles files_;
  MeshSize size_;
  BuiltModel model_;
  std::vector<std::string> notes_;  // of the reader
  std::optional<TriangleRuns> whole_;
  std::optional<TriangleRuns> part_;  // triangles of whole_ that touch the region
  std::optional<CapTree> caps_;
  std::optional<MaskSectors> sectors_;
  std::optional<BuiltTree> tree_;
};

}  // namespace planetree::octree
