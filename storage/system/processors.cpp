#include "storage/system/processors.h"

#include <sched.h>

#include <algorithm>
#include <exception>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

namespace planetree::storage {
namespace {

constexpr double kNoQuota = std::numeric_limits<double>::infinity();

unsigned affine_processors() {
  cpu_set_t mask;
  if (::sched_getaffinity(0, sizeof mask, &mask) == 0)
    return static_cast<unsigned>(std::max(CPU_COUNT(&mask), 1));
  return std::max(std::thread::hardware_concurrency(), 1U);  // more processors than the mask holds
}

// Processors of a group of version 2: the file has the quota, or "max", and the period.
double quota_of_v2(const std::filesystem::path& group) {
  std::ifstream file(group / "cpu.max");
  std::string quota;
  double period = 0;
  if (!(file >> quota >> period) || quota == "max" || period <= 0) return kNoQuota;
  return std::stod(quota) / period;
}

// Processors of a group of version 1; a quota of -1 means none.
double quota_of_v1(const std::filesystem::path& group) {
  double quota = 0, period = 0;
  std::ifstream(group / "cpu.cfs_quota_us") >> quota;
  std::ifstream(group / "cpu.cfs_period_us") >> period;
  return quota > 0 && period > 0 ? quota / period : kNoQuota;
}

// The least quota of a group and the groups above it. In a container the group may be mounted as
// the root, so that its path does not exist there.
template <class QuotaOf>
double least_quota(const std::filesystem::path& mount, std::filesystem::path group,
                   const QuotaOf& quota_of) {
  double least = quota_of(mount);
  for (group = group.relative_path(); !group.empty(); group = group.parent_path())
    least = std::min(least, quota_of(mount / group));
  return least;
}

// Whether a list of controllers, separated by commas, has "cpu".
bool has_cpu(const std::string& controllers) {
  return ("," + controllers + ",").find(",cpu,") != std::string::npos;
}

double cgroup_processors(const std::filesystem::path& process, const std::filesystem::path& mount) {
  std::ifstream groups(process);
  double least = kNoQuota;
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::filesystem::path group = line.substr(second + 1);
    if (controllers.empty()) least = std::min(least, least_quota(mount, group, quota_of_v2));
    if (has_cpu(controllers))
      least = std::min(least, least_quota(mount / "cpu", group, quota_of_v1));
  }
  return least;
}

}  // namespace

unsigned usable_processors(const std::filesystem::path& process,
                           const std::filesystem::path& mount) noexcept {
  const unsigned affine = affine_processors();
  double quota = kNoQuota;
  try {
    quota = cgroup_processors(process, mount);
  } catch (const std::exception&) {  // no memory, or a number that is none
  }
  for (unsigned count = 1; count < affine; ++count)
    if (quota <= count) return count;
  return affine;
}

}  // namespace planetree::storage
