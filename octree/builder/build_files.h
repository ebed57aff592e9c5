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

/// The files of a build beside its input and output: temporary files without names and, for a build
/// that can be resumed, the checkpoint.
///
/// threads  as SpillFile and Checkpoint.
class BuildFiles {
 public:
  /// output, options  determine the directories.
  /// calls            the system; must outlive this.
  BuildFiles(const std::filesystem::path& output, const BuildOptions& options,
             const BuildMemory& memory, storage::FileCalls& calls);

  /// Opens the checkpoint and resumes its work. For a build that can be resumed; call it once,
  /// before everything else.
  /// errors  those of Checkpoint::open().
  Result<void> resume_work(const BuildIdentity& identity);
  /// The checkpoint; null if there is none.
  Checkpoint* work() { return work_.get(); }
  /// Removes the checkpoint, if there is one. Call it when the output is complete.
  Result<void> remove_work();

  /// For reading the mesh.
  MeshScratch& mesh() { return mesh_; }
  const MeshScratch& mesh() const { return mesh_; }
  /// For data that only this process needs.
  storage::SpillFile& scratch() { return scratch_; }
  /// For data that a later build could resume: sorted triangles, and pages.
  storage::SpillFile& triangles() { return work_ ? work_->spill() : scratch_; }
  storage::SpillFile& pages() { return work_ ? work_->spill() : pages_; }

  /// Bytes that are on disk, those of resumed work included.
  std::uint64_t disk_bytes() const;
  /// Checks whether there is enough space for `need`, that of the output included.
  /// errors  those of SpaceNeed::check().
  Result<void> check_space(const SpaceNeed& need);
  /// The directory where something failed or is short of space, and the path; nothing if no call
  /// here failed.
  std::optional<std::pair<BuildDirectory, std::filesystem::path>> failed_at() const;

 private:
  const std::filesystem::path output_;
  const std::filesystem::path directory_;
  const std::filesystem::path work_directory_;
  storage::FileCalls& calls_;
  std::unique_ptr<Checkpoint> work_;
  bool work_failed_ = false;  // to be opened, or to be removed
  std::optional<BuildDirectory> short_of_space_;
  MeshScratch mesh_;
  storage::SpillFile scratch_;
  storage::SpillFile pages_;
};

}  // namespace planetree::octree
