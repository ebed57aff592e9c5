#pragma once

#include <filesystem>

namespace planetree::storage {

/// Returns the number of processors that this process can use, at least 1: those of its affinity
/// mask, but no more than the processor time that its cgroup and the groups above allow, rounded
/// up. Does not throw; what cannot be read limits nothing.
///
/// process  lists the groups of the process, as /proc/self/cgroup does.
/// mount    where groups are mounted, of version 2, or of version 1 with a directory `cpu`.
unsigned usable_processors(const std::filesystem::path& process = "/proc/self/cgroup",
                           const std::filesystem::path& mount = "/sys/fs/cgroup") noexcept;

}  // namespace planetree::storage
