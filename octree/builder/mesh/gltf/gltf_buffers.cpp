#include "octree/builder/mesh/gltf/gltf_buffers.h"

#include <optional>
#include <string>
#include <utility>

#include "octree/builder/mesh/gltf/base64.h"
#include "octree/builder/mesh/gltf/gltf_error.h"
#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::octree {

namespace {

std::string buffer_name(std::uint64_t buffer) { return "buffer " + std::to_string(buffer); }

std::optional<unsigned> digit_of(char c) {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a' + 10);
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A' + 10);
  return std::nullopt;
}

/// Replaces "%20" and the like by the bytes that they stand for.
std::string without_escapes(std::string_view uri) {
  std::string plain;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size()) {
      const auto high = digit_of(uri[i + 1]), low = digit_of(uri[i + 2]);
      if (high && low) {
        plain += static_cast<char>(*high * 16 + *low);
        i += 2;
        continue;
      }
    }
    plain += uri[i];
  }
  return plain;
}

}  // namespace

Result<std::filesystem::path> gltf_buffer_path(const std::filesystem::path& gltf,
                                               std::string_view uri) {
  const std::string name = without_escapes(uri);
  const bool has_scheme = uri.substr(0, uri.find('/')).find(':') != std::string_view::npos;
  if (name.empty() || has_scheme || name.front() == '/' || name.find('\0') != std::string::npos)
    return gltf_error("the buffer '" + printable(uri) + "' is no file beside the glTF",
                      "name it by a relative path");
  if (gltf.empty())
    return gltf_error("the buffer '" + printable(uri) + "' is beside a glTF that is compressed",
                      "unpack the glTF");
  return gltf.parent_path() / name;
}

Result<GltfBuffers::Source> GltfBuffers::find_binary(std::uint64_t buffer) const {
  const GltfBuffer& declared = document_.buffers[buffer];
  if (declared.is_fallback)
    return gltf_error(buffer_name(buffer) + " is compressed by meshoptimizer",
                      "export it without compression");
  if (!parts_.has_binary || buffer != 0)
    return gltf_error(buffer_name(buffer) + " has neither a URI nor a binary chunk");
  // The chunk is filled up to a multiple of four bytes.
  constexpr std::uint64_t kFill = 3;
  if (parts_.binary.bytes() > declared.bytes && parts_.binary.bytes() - declared.bytes > kFill)
    return gltf_error_at(parts_.binary.begin,
                         "the binary chunk has " + std::to_string(parts_.binary.bytes()) +
                             " bytes, buffer 0 declares " + std::to_string(declared.bytes));
  return Source{nullptr, parts_.binary};
}

Result<GltfBuffers::Source> GltfBuffers::find(std::uint64_t buffer) const {
  const GltfBuffer& declared = document_.buffers[buffer];
  if (declared.embedded) {
    if (*declared.embedded >= document_.embedded.size())
      return gltf_error(buffer_name(buffer) + " embeds data that is not in base64");
    auto decoded = decode_base64(file_, document_.embedded[*declared.embedded], scratch_);
    if (!decoded) return decoded.error();
    const std::uint64_t bytes = decoded->size_bytes();
    return Source{std::make_unique<MeshFile>(std::move(*decoded)), {0, bytes}};
  }
  if (!declared.uri) return find_binary(buffer);
  const auto path = gltf_buffer_path(path_, *declared.uri);
  if (!path) return path.error();
  auto opened = MeshFile::open(*path, scratch_.calls());
  if (!opened)
    return make_error(opened.error().code, Error::kNowhere, Error::kNowhere, "%s, '%s': %s",
                      buffer_name(buffer).c_str(), printable(*declared.uri).c_str(),
                      opened.error().text);
  const std::uint64_t bytes = opened->size_bytes();
  return Source{std::make_unique<MeshFile>(std::move(*opened)), {0, bytes}};
}

Result<GltfBuffers::Bytes> GltfBuffers::open(std::uint64_t buffer) {
  if (buffer >= document_.buffers.size())
    return gltf_error(buffer_name(buffer) + " does not exist");
  auto known = sources_.find(buffer);
  if (known == sources_.end()) {
    auto found = find(buffer);
    if (!found) return found.error();
    const std::uint64_t declared = document_.buffers[buffer].bytes;
    if (found->range.bytes() < declared)
      return gltf_error(buffer_name(buffer) + " declares " + std::to_string(declared) +
                        " bytes and has " + std::to_string(found->range.bytes()) + ": truncated");
    found->range.end = found->range.begin + declared;
    known = sources_.emplace(buffer, std::move(*found)).first;
  }
  const Source& source = known->second;
  return Bytes{source.file ? source.file.get() : &file_, source.range};
}

}  // namespace planetree::octree
