#include "storage/system/device_space.h"

#include <fcntl.h>

#include <limits>

namespace planetree::storage {

DeviceSpace DeviceSpace::of(const std::filesystem::path& directory, FileCalls& calls) noexcept {
  const char* const path = directory.empty() ? "." : directory.c_str();
  DeviceSpace space;
  struct stat status;
  if (calls.fstatat(AT_FDCWD, path, &status, 0) == 0)
    space.device = static_cast<std::uint64_t>(status.st_dev);
  struct statvfs found;
  // A file system that reports 0 blocks in total does not count them.
  if (calls.statvfs(path, &found) != 0 || found.f_blocks == 0) return space;
  std::uint64_t bytes = 0;
  const bool too_many =
      __builtin_mul_overflow(std::uint64_t{found.f_bavail}, std::uint64_t{found.f_frsize}, &bytes);
  space.free_bytes = too_many ? std::numeric_limits<std::uint64_t>::max() : bytes;
  return space;
}

}  // namespace planetree::storage
