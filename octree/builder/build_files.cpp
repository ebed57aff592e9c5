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

Result<void> BuildFiles::take_up_work(const BuildIdentity& identity) {
  auto work = KeptWork::open(work_directory_, identity, calls_);
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

Result<void> BuildFiles::look_for(const SpaceNeed& need) {
  BuildPlace place = BuildPlace::kTemporary;
  const auto checked =
      need.check(directory_, BuildOptions::output_directory(output_), calls_, place);
  if (!checked) short_of_room_ = place;
  return checked;
}

std::optional<std::pair<BuildPlace, std::filesystem::path>> BuildFiles::failed_at() const {
  if (work_failed_ || (work_ && work_->failed()))
    return std::pair(BuildPlace::kTemporary, work_directory_);
  if (short_of_room_ == BuildPlace::kOutput) return std::pair(BuildPlace::kOutput, output_);
  if (short_of_room_ || mesh_.failed() || scratch_.failed() || pages_.failed())
    return std::pair(BuildPlace::kTemporary, directory_);
  return {};
}

}  // namespace planetree::octree
