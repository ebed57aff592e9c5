#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "octree/builder/build_identity.h"
#include "octree/builder/checkpoint.h"
#include "octree/builder/job/build_memory.h"
#include "octree/builder/job/build_options.h"
#include "octree/builder/job/build_progress.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/space_need.h"
#include "planetree/error.h"
#include "storage/spill/spill_file.h"
#include "storage/system/file_calls.h"

namespace planetree::octree {

/// What a build has on disk beside its input and output: files without names, and the work that
/// it keeps, if it can be resumed.
///
/// threads  as SpillFile and Checkpoint.
class BuildFiles {
 public:
  /// output, options  tell where.
  /// calls            the system; must outlive this.
  BuildFiles(const std::filesystem::path& output, const BuildOptions& options,
             const BuildMemory& memory, storage::FileCalls& calls);

  /// Of a build that can be resumed, once and before all else: takes up what there is.
  /// errors  those of Checkpoint::open().
  Result<void> resume_work(const BuildIdentity& identity);
  /// What is kept; null: nothing is.
  Checkpoint* work() { return work_.get(); }
  /// The output is there, whole: removes what was kept, if anything was.
  Result<void> remove_work();

  /// For the mesh while it is read.
  MeshScratch& mesh() { return mesh_; }
  /// For what only this process needs.
  storage::SpillFile& scratch() { return scratch_; }
  /// For what a later build could go on with: triangles in order, and pages.
  storage::SpillFile& triangles() { return work_ ? work_->spill() : scratch_; }
  storage::SpillFile& pages() { return work_ ? work_->spill() : pages_; }

  /// On disk by now, and what was taken up.
  std::uint64_t disk_bytes() const;
  /// Whether there is room for what is needed, of the output too.
  /// errors  those of SpaceNeed::check().
  Result<void> look_for(const SpaceNeed& need);
  /// Where something failed or is short of room, and its path; of what no call here was about,
  /// nothing.
  std::optional<std::pair<BuildDirectory, std::filesystem::path>> failed_at() const;

 private:
  const std::filesystem::path output_;
  const std::filesystem::path directory_;
  const std::filesystem::path work_directory_;
  storage::FileCalls& calls_;
  std::unique_ptr<Checkpoint> work_;
  bool work_failed_ = false;  // to be there, or to go
  std::optional<BuildDirectory> short_of_space_;
  MeshScratch mesh_;
  storage::SpillFile scratch_;
  storage::SpillFile pages_;
};

}  // namespace planetree::octree
