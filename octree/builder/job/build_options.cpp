#include "octree/builder/job/build_options.h"

#include <bit>
#include <cstdio>
#include <span>
#include <string>
#include <system_error>

#include "storage/file/checksum.h"

namespace planetree::octree {

Result<void> BuildOptions::check() const {
  if (!std::has_single_bit(page_bytes) || page_bytes < storage::kMinPageBytes ||
      page_bytes > storage::kMaxPageBytes)
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "a page of %u bytes; use a power of two from 4K to 256K", page_bytes);
  if ((layers & ~kAllLayers) != 0)
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "layers are 0x%x; combine kSideLayer, kFieldLayer and kAttributeLayer",
                      layers);
  if ((keep & ~kAllAttributes) != 0)
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "attributes are 0x%x; combine kKeepTriangles, kKeepColor, kKeepUv and "
                      "kKeepValue",
                      keep);
  if (member_bytes > 0 && member_bytes < kMinMemberBytes)
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "members of %llu bytes; use 64K or more",
                      static_cast<unsigned long long>(member_bytes));
  return box ? box->check() : Result<void>();
}

std::filesystem::path BuildOptions::output_directory(const std::filesystem::path& output) {
  return output.has_parent_path() ? output.parent_path() : ".";
}

std::filesystem::path BuildOptions::spill_directory(const std::filesystem::path& output) const {
  return temp_directory.empty() ? output_directory(output) : temp_directory;
}

// Outputs of one name may share temp_directory: a hash of the output's path tells them apart.
std::filesystem::path BuildOptions::work_directory(const std::filesystem::path& output) const {
  std::filesystem::path name = output.filename();
  if (!temp_directory.empty()) {
    std::error_code ignored;
    const std::string whole =
        (std::filesystem::weakly_canonical(output_directory(output), ignored) / name).string();
    char digits[20];
    std::snprintf(digits, sizeof digits, "-%016llx",
                  static_cast<unsigned long long>(
                      storage::hash64(std::as_bytes(std::span(whole.data(), whole.size())))));
    name += digits;
  }
  name += ".work";
  return (temp_directory.empty() ? output.parent_path() : temp_directory) / name;
}

}  // namespace planetree::octree
