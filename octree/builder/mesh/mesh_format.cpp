#include "octree/builder/mesh/mesh_format.h"

#include <algorithm>
#include <string>

#include "octree/builder/mesh/foreign_format.h"
#include "octree/builder/mesh/gltf/gltf_file.h"
#include "octree/builder/mesh/off_reader.h"
#include "octree/builder/mesh/ply_reader.h"
#include "octree/builder/mesh/stl_reader.h"

namespace planetree::octree {
namespace {

/// Length of the prefix that is looked at.
constexpr std::uint64_t kProbeBytes = 4096;

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return extension;
}

Error refusal(const ForeignFormat& format) {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, 0, "byte 0: the file is %.*s; %.*s",
                    static_cast<int>(format.name.size()), format.name.data(),
                    static_cast<int>(format.remedy.size()), format.remedy.data());
}

}  // namespace

Result<Packing> detect_packing(const MeshFile& file) {
  const auto prefix = file.prefix(kProbeBytes);
  if (!prefix) return prefix.error();
  if (has_binary_stl_size(*prefix, file.size_bytes())) return Packing::kNone;
  return packing_of(*prefix);
}

std::filesystem::path unpacked_path(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  const bool is_packed = extension == ".gz" || extension == ".zst" || extension == ".zstd";
  return is_packed ? path.parent_path() / path.stem() : path;
}

Result<MeshFormat> detect_format(const MeshFile& file, const std::filesystem::path& path) {
  const auto prefix = file.prefix(kProbeBytes);
  if (!prefix) return prefix.error();
  if (is_ply(*prefix)) return MeshFormat::kPly;
  if (has_binary_stl_size(*prefix, file.size_bytes())) return MeshFormat::kStlBinary;
  const std::string extension = lower_extension(path);
  if (is_glb(*prefix) || is_gltf_json(*prefix, extension == ".gltf")) return MeshFormat::kGltf;
  if (const auto foreign = foreign_format(*prefix)) return refusal(*foreign);
  if (is_ascii_stl(*prefix)) return MeshFormat::kStlAscii;
  if (is_off(*prefix)) return MeshFormat::kOff;
  if (extension == ".obj") return MeshFormat::kObj;
  // An OFF without a keyword, as old files are.
  if (extension == ".off") return MeshFormat::kOff;
  // A binary STL whose size is wrong. Its reader reports in which way.
  if (extension == ".stl") return MeshFormat::kStlBinary;
  return MeshFormat::kUnknown;
}

}  // namespace planetree::octree
