#include "octree/builder/build_identity.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <numeric>
#include <variant>
#include <vector>

#include "octree/builder/mesh/side_files.h"
#include "storage/system/file_error.h"
#include "storage/system/file_handle.h"

namespace planetree::octree {
namespace {

/// To be raised with every change of the records or of what trees consist of.
constexpr int kWorkVersion = 12;

constexpr std::uint64_t kSampleBlocks = 64;
constexpr std::uint64_t kBlockBytes = 4096;

Error input_error(const char* what) {
  return storage::file_error(errno, storage::FileAction::kRead, what);
}

// Hashes blocks that are spread from the first byte to the last; all of a small file.
Result<storage::Hash128> sample_of(const storage::FileHandle& file, std::uint64_t file_bytes) {
  storage::Hasher hasher;
  std::vector<std::byte> block(kBlockBytes);
  const std::uint64_t last = file_bytes - std::min(file_bytes, kBlockBytes);
  std::uint64_t next = 0;  // bytes before it are in the sample
  for (std::uint64_t i = 0; i < kSampleBlocks; ++i) {
    const bool at_end = i + 1 == kSampleBlocks;
    const std::uint64_t from = std::max(next, at_end ? last : last / (kSampleBlocks - 1) * i);
    const std::uint64_t to = std::min(from + kBlockBytes, file_bytes);
    if (to <= from) continue;
    const std::span<std::byte> bytes = std::span(block).first(to - from);
    if (const auto read = file.read_at(from, bytes); !read) return read.error();
    hasher.add(bytes);
    next = to;
  }
  return hasher.value();
}

Result<InputIdentity> identity_of_file(const std::filesystem::path& input,
                                       storage::FileCalls& calls) {
  // With O_NONBLOCK a FIFO without a writer is refused instead of waited for.
  const auto file =
      storage::FileHandle::open(calls, AT_FDCWD, input.c_str(), O_RDONLY | O_NONBLOCK);
  if (!file.is_open()) return input_error("open the file");
  struct stat status;
  if (calls.fstat(file.descriptor(), &status) != 0) return input_error("examine the file");
  if (!S_ISREG(status.st_mode))
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "not a regular file; a mesh is read out of order, so copy it into a file");
  InputIdentity identity;
  identity.bytes = static_cast<std::uint64_t>(status.st_size);
  identity.number = status.st_ino;
  identity.changed_seconds = status.st_ctim.tv_sec;
  identity.changed_nanoseconds = status.st_ctim.tv_nsec;
  const auto sample = sample_of(file, identity.bytes);
  if (!sample) return sample.error();
  identity.sample_low = sample->low;
  identity.sample_high = sample->high;
  return identity;
}

// That of other files which the mesh is read with is part of the sample.
Result<InputIdentity> identity_of(const std::filesystem::path& input, storage::FileCalls& calls) {
  auto identity = identity_of_file(input, calls);
  if (!identity) return identity;
  const auto side_files = side_files_of(input, calls);
  if (!side_files) return side_files.error();
  if (side_files->empty()) return identity;
  storage::Hasher hasher;
  const auto add = [&hasher](const InputIdentity& of) {
    const std::array<std::uint64_t, 6> numbers = {
        of.bytes,
        of.number,
        static_cast<std::uint64_t>(of.changed_seconds),
        static_cast<std::uint64_t>(of.changed_nanoseconds),
        of.sample_low,
        of.sample_high};
    hasher.add(std::as_bytes(std::span(numbers)));
  };
  add(*identity);
  for (const std::filesystem::path& path : *side_files) {
    const auto side = identity_of_file(path, calls);
    // The reader of the mesh names the file that it cannot open.
    add(side ? *side : InputIdentity());
  }
  identity->sample_low = hasher.value().low;
  identity->sample_high = hasher.value().high;
  return identity;
}

template <class Vertex>
InputIdentity identity_of(const BuildInput::Mesh<Vertex>& mesh) {
  storage::Hasher hasher;
  hasher.add(std::as_bytes(mesh.vertices));
  hasher.add(std::as_bytes(mesh.triangles));
  hasher.add(std::as_bytes(mesh.colors));
  hasher.add(std::as_bytes(mesh.uvs));
  hasher.add(std::as_bytes(mesh.values));
  hasher.add(std::as_bytes(std::span(&mesh.value_kind, 1)));
  InputIdentity identity;
  identity.bytes = mesh.vertices.size_bytes() + mesh.triangles.size_bytes();
  identity.number = sizeof(Vertex);
  identity.sample_low = hasher.value().low;
  identity.sample_high = hasher.value().high;
  return identity;
}

struct IdentityOf {
  using Identities = std::vector<InputIdentity>;

  Result<Identities> operator()(const std::filesystem::path& path) const {
    const auto identity = identity_of(path, calls);
    return identity ? Result<Identities>({*identity}) : identity.error();
  }
  Result<Identities> operator()(const BuildInput::Files& files) const {
    if (files.paths.empty())
      return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                        "an empty list of mesh files; give at least one");
    Identities all;
    for (const std::filesystem::path& path : files.paths) {
      const auto identity = identity_of(path, calls);
      if (!identity && failed_at != nullptr) *failed_at = path;
      if (!identity) return identity.error();
      all.push_back(*identity);
    }
    return all;
  }
  Result<Identities> operator()(const BuildInput::Stream&) const {
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "triangles of a callback cannot be compared with those of an earlier build; "
                      "build without resume, or from a file");
  }
  template <class Vertex>
  Result<Identities> operator()(const BuildInput::Mesh<Vertex>& mesh) const {
    return Identities{identity_of(mesh)};
  }
  storage::FileCalls& calls;
  std::filesystem::path* failed_at;
};

// Says in words how the files of an input differ from those of an earlier one.
std::string change_of(const std::vector<InputIdentity>& now,
                      const std::vector<InputIdentity>& earlier) {
  if (now.size() != earlier.size()) return "the number of input files has changed";
  if (now.size() == 1) return "the input has changed";
  const auto differing = std::ranges::mismatch(now, earlier).in1 - now.begin();
  return "input file " + std::to_string(differing + 1) + " of " + std::to_string(now.size()) +
         " has changed";
}

}  // namespace

std::string work_version() {
  return PLANETREE_VERSION " " + std::to_string(storage::kFormatVersion) + " " +
         std::to_string(kWorkVersion);
}

Result<BuildIdentity> BuildIdentity::of(const BuildInput& input, const BuildOptions& options,
                                        const BuildSeams& seams, std::filesystem::path* failed_at) {
  auto found = std::visit(IdentityOf{seams.calls, failed_at}, input.content());
  if (!found) return found.error();
  BuildIdentity identity;
  identity.version = work_version();
  identity.inputs = *std::move(found);
  identity.page_bytes = options.page_bytes;
  identity.with_sides = options.has_side_layer();
  identity.attributes = options.kept_attributes();
  identity.value_property = options.value_property;
  identity.strict = options.strict;
  identity.float64 = options.float64;
  identity.chunk_triangles = seams.chunk_triangles;
  identity.sector_triangles = seams.sector_triangles;
  if (options.box) {
    const auto& [lower, upper] = *options.box;
    identity.box = {lower.x, lower.y, lower.z, upper.x, upper.y, upper.z};
  }
  return identity;
}

std::uint64_t BuildIdentity::input_bytes() const {
  return std::accumulate(
      inputs.begin(), inputs.end(), std::uint64_t{0},
      [](std::uint64_t sum, const InputIdentity& input) { return sum + input.bytes; });
}

std::string BuildIdentity::change_since(const BuildIdentity& earlier) const {
  if (*this == earlier) return {};
  if (version != earlier.version) return "another version wrote it";
  return inputs == earlier.inputs ? "the options have changed" : change_of(inputs, earlier.inputs);
}

}  // namespace planetree::octree
