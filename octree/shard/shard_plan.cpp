#include "octree/shard/shard_plan.h"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <span>
#include <utility>

#include "octree/builder/job/input_paths.h"
#include "octree/builder/mesh/side_files.h"
#include "storage/system/file_error.h"
#include "storage/system/file_handle.h"
#include "storage/system/read_parts.h"

namespace planetree::octree {
namespace {

Result<void> hash_file(const std::filesystem::path& path, storage::FileCalls& calls,
                       storage::Hasher& hasher) {
  const auto file = storage::FileHandle::open(calls, AT_FDCWD, path.c_str(), O_RDONLY);
  if (!file.is_open())
    return storage::file_error(errno, storage::FileAction::kRead, "open the file");
  const auto size = file.size_bytes();
  if (!size) return size.error();
  const auto read =
      storage::read_parts(file, *size, [&hasher](const auto& part) { hasher.add(part); });
  if (!read) return read;
  const std::uint64_t length = *size;
  hasher.add(std::as_bytes(std::span(&length, 1)));
  return {};
}

Error changed(const char* what) {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "%s since the job was planned; run 'planetree shard plan' again", what);
}

}  // namespace

void ShardPlan::impose_on(BuildOptions& options) const {
  options.page_bytes = identity.page_bytes;
  options.float64 = identity.float64;
  options.strict = identity.strict;
  options.value_property = identity.value_property;
  options.layers = layers;
  options.keep = keep;
  options.side = side;
  options.box.reset();
  options.resume = false;
  options.metadata.clear();
  for (std::size_t i = 0; i + 1 < metadata.size(); i += 2)
    options.metadata[metadata[i]] = metadata[i + 1];
}

ShardPlan ShardPlan::of(const BuildInput& input, std::uint32_t shards,
                        const BuildIdentity& identity, const BuildOptions& options) {
  ShardPlan plan;
  plan.shards = shards;
  for (const std::filesystem::path& path : paths_of(input))
    plan.inputs.push_back(std::filesystem::absolute(path).lexically_normal().string());
  plan.identity = identity;
  plan.layers = options.layers;
  plan.keep = options.keep;
  plan.side = options.side;
  for (const auto& [key, value] : options.metadata) {
    plan.metadata.push_back(key);
    plan.metadata.push_back(value);
  }
  return plan;
}

bool ShardPlan::is_like(const ShardPlan& other) const {
  return shards == other.shards && inputs == other.inputs && identity == other.identity &&
         layers == other.layers && keep == other.keep && side == other.side &&
         metadata == other.metadata;
}

MeshFileRange ShardPlan::files_with(std::uint64_t first_index, std::uint64_t end_index) const {
  MeshFileRange files;
  std::uint64_t begin = 0;  // index with which a file begins
  for (std::size_t i = 0; i < inputs.size() && begin < end_index; ++i) {
    const std::uint64_t end = begin + mesh.file_indices[i];
    if (first_index < end_index && first_index < end) {
      if (files.count == 0) files = {i, 0, begin};
      ++files.count;
    }
    begin = end;
  }
  return files;
}

BuildInput ShardPlan::input_of(const MeshFileRange& files) const {
  const auto paths = std::span(inputs).subspan(files.first, files.count);
  return BuildInput(std::vector<std::filesystem::path>(paths.begin(), paths.end()));
}

std::uint64_t first_of_part(std::uint64_t part, std::uint64_t count, std::uint64_t parts) {
  // The first `count % parts` parts have one more than the others.
  return count / parts * part + std::min(part, count % parts);
}

Result<storage::Hash128> content_of(const std::filesystem::path& input, storage::FileCalls& calls) {
  storage::Hasher hasher;
  if (const auto hashed = hash_file(input, calls, hasher); !hashed) return hashed.error();
  const auto side_files = side_files_of(input, calls);
  if (!side_files) return side_files.error();
  // The reader of the mesh names the file that it cannot open.
  for (const std::filesystem::path& path : *side_files) (void)hash_file(path, calls, hasher);
  return hasher.value();
}

Result<std::vector<InputIdentity>> check_files(const ShardPlan& plan, const MeshFileRange& files,
                                               const BuildOptions& options, const BuildSeams& seams,
                                               std::filesystem::path& failed_at) {
  failed_at = plan.inputs[files.first];
  auto now = BuildIdentity::of(plan.input_of(files), options, seams, &failed_at);
  if (!now) return now.error();
  if (now->version != plan.identity.version) return changed("this release differs from the one");
  for (std::size_t i = 0; i < files.count; ++i) {
    const InputIdentity& planned = plan.identity.inputs[files.first + i];
    if (now->inputs[i] == planned) continue;
    failed_at = plan.inputs[files.first + i];
    if (now->inputs[i].bytes != planned.bytes) return changed("the input has changed");
    const auto content = content_of(failed_at, seams.calls);
    if (!content) return content.error();
    if (*content != plan.contents[files.first + i]) return changed("the input has changed");
  }
  return std::move(now->inputs);
}

Result<void> check_unchanged(const ShardPlan& plan, const MeshFileRange& files,
                             const std::vector<InputIdentity>& before, const BuildOptions& options,
                             const BuildSeams& seams, std::filesystem::path& failed_at) {
  failed_at = plan.inputs[files.first];
  const auto after = BuildIdentity::of(plan.input_of(files), options, seams, &failed_at);
  if (!after) return after.error();
  const auto differing = std::ranges::mismatch(after->inputs, before).in1 - after->inputs.begin();
  if (static_cast<std::size_t>(differing) == files.count) return {};
  failed_at = plan.inputs[files.first + static_cast<std::size_t>(differing)];
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "the input changed while it was read; plan again when it is complete");
}

}  // namespace planetree::octree
