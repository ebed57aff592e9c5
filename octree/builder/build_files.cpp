#include "octree/builder/build_files.h"

#include <utility>

namespace planetree::octree {

BuildFiles::BuildFiles(const std::filesystem::path& output, const BuildOptions& options,
                       const BuildMemory& memory, storage::FileCalls& calls)
    : output_(output),
      directory_(options.spill_directory(output)),
      work_directory_(options.work_directory(output)),
      calls_(calls),
      mesh_(memory.reading_bytes, directory_, calls),
      scratch_(directory_, 0, calls),
      pages_(directory_, memory.pages_bytes, calls) {}

Result<void> BuildFiles::resume_work(const BuildIdentity& identity) {
  auto work = Checkpoint::open(work_directory_, identity, calls_);
  work_failed_ = !work;
  if (!work) return work.error();
  work_ = *std::move(work);
  return {};
}

Result<void> BuildFiles::remove_work() {
  if (!work_) return {};
  const auto removed = work_->remove();
  work_failed_ = !removed;
  return removed;
}

std::uint64_t BuildFiles::disk_bytes() const {
  return mesh_.disk_bytes() + scratch_.disk_bytes() + pages_.disk_bytes() +
         (work_ ? work_->disk_bytes() : 0);
}

Result<void> BuildFiles::check_space(const SpaceNeed& need) {
  BuildDirectory directory = BuildDirectory::kTemporary;
  const auto checked =
      need.check(directory_, BuildOptions::output_directory(output_), calls_, directory);
  if (!checked) short_of_space_ = directory;
  return checked;
}

std::optional<std::pair<BuildDirectory, std::filesystem::path>> BuildFiles::failed_at() const {
  if (work_failed_ || (work_ && work_->failed()))
    return std::pair(BuildDirectory::kTemporary, work_directory_);
  if (short_of_space_ == BuildDirectory::kOutput)
    return std::pair(BuildDirectory::kOutput, output_);
  if (short_of_space_ || mesh_.failed() || scratch_.failed() || pages_.failed())
    return std::pair(BuildDirectory::kTemporary, directory_);
  return {};
}

}  // namespace planetree::octree
