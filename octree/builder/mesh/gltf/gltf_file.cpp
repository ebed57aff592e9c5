#include "octree/builder/mesh/gltf/gltf_file.h"

#include <array>
#include <cstddef>
#include <span>

#include "octree/builder/mesh/gltf/gltf_error.h"
#include "octree/builder/mesh/stream/mesh_text.h"
#include "octree/builder/mesh/stream/scalar_type.h"

// Sources: glTF 2.0 specification (Khronos, 2021), section 4, "GLB File Format Specification".
namespace planetree::octree {

namespace {

constexpr std::string_view kMagic = "glTF";
constexpr std::uint64_t kHeaderBytes = 12;
constexpr std::uint64_t kChunkHeaderBytes = 8;
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

struct Chunk {
  std::uint32_t type = 0;
  FileRange content;
};

template <std::size_t kCount>
Result<std::array<std::uint32_t, kCount>> read_numbers(const MeshFile& file, std::uint64_t offset) {
  std::array<std::byte, kCount * sizeof(std::uint32_t)> raw;
  if (const auto read = file.read(offset, raw); !read) return read.error();
  std::array<std::uint32_t, kCount> numbers;
  for (std::size_t i = 0; i < kCount; ++i)
    numbers[i] = load<std::uint32_t>(raw.data() + i * sizeof(std::uint32_t), kSwapLittle);
  return numbers;
}

/// Reads the chunk that begins at `offset`.
Result<Chunk> read_chunk(const MeshFile& file, std::uint64_t offset, std::uint64_t end) {
  if (end - offset < kChunkHeaderBytes)
    return gltf_error_at(offset, "the GLB ends within the header of a chunk");
  const auto numbers = read_numbers<2>(file, offset);
  if (!numbers) return numbers.error();
  const auto [bytes, type] = *numbers;
  const std::uint64_t begin = offset + kChunkHeaderBytes;
  if (bytes > end - begin)
    return gltf_error_at(offset, "a chunk of " + std::to_string(bytes) + " bytes, where " +
                                     std::to_string(end - begin) + " are left");
  return Chunk{type, {begin, begin + bytes}};
}

/// Checks the header and returns the length that it states.
Result<std::uint64_t> read_length(const MeshFile& file) {
  if (file.size_bytes() < kHeaderBytes)
    return gltf_error_at(file.size_bytes(), "the file ends within the header of a GLB");
  const auto numbers = read_numbers<2>(file, kMagic.size());
  if (!numbers) return numbers.error();
  const auto [version, length] = *numbers;
  if (version != kVersion)
    return gltf_error_at(kMagic.size(),
                         "a GLB of glTF version " + std::to_string(version) + ", not 2",
                         "export it as glTF 2.0");
  if (length > file.size_bytes() || length < kHeaderBytes)
    return gltf_error_at(2 * sizeof(std::uint32_t),
                         "a GLB of " + std::to_string(length) + " bytes in a file of " +
                             std::to_string(file.size_bytes()) + ": truncated or damaged");
  return length;
}

}  // namespace

bool is_glb(std::string_view file) noexcept { return file.starts_with(kMagic); }

bool is_gltf_json(std::string_view file, bool is_named_gltf) noexcept {
  std::string_view text = file.substr(text_begin(file).offset);
  skip_blanks(text);
  if (!text.starts_with('{')) return false;
  if (is_named_gltf) return true;
  for (const std::string_view word : {"\"asset\"", "\"accessors\"", "\"bufferViews\""})
    if (text.find(word) != std::string_view::npos) return true;
  return false;
}

Result<GltfParts> find_gltf_parts(const MeshFile& file) {
  const auto prefix = file.prefix(kMagic.size());
  if (!prefix) return prefix.error();
  GltfParts parts;
  if (!is_glb(*prefix)) {
    parts.json = {0, file.size_bytes()};
    return parts;
  }
  const auto length = read_length(file);
  if (!length) return length.error();
  const auto json = read_chunk(file, kHeaderBytes, *length);
  if (!json) return json.error();
  if (json->type != kJsonChunk)
    return gltf_error_at(kHeaderBytes, "the first chunk of the GLB is not its JSON");
  parts.json = json->content;
  parts.surplus = file.size_bytes() - *length;
  // Only the second chunk may be the buffer. Those behind it have no meaning yet.
  for (std::uint64_t at = json->content.end; at < *length;) {
    const auto chunk = read_chunk(file, at, *length);
    if (!chunk) return chunk.error();
    if (at == json->content.end && chunk->type == kBinaryChunk) {
      parts.binary = chunk->content;
      parts.has_binary = true;
    }
    at = chunk->content.end;
  }
  return parts;
}

}  // namespace planetree::octree
