#include "octree/builder/mesh/stream/packing.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "octree/builder/mesh/mesh_format.h"
#include "octree/builder/mesh/mesh_reader.h"
#include "tests/fuzz/mesh_fuzz.h"
#include "tests/fuzz/mesh_mutator.h"

namespace planetree {
namespace {

constexpr std::size_t kMaxContent = 4096;
constexpr int kGzip = 15 + 16;  // window bits of zlib, with gzip's head and tail

std::optional<std::string> unpack_gzip(std::string_view packed) {
  z_stream stream{};
  if (inflateInit2(&stream, kGzip) != Z_OK) return {};
  std::string content(kMaxContent, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(content.data());
  stream.avail_out = kMaxContent;
  const int status = inflate(&stream, Z_FINISH);
  content.resize(stream.total_out);
  inflateEnd(&stream);
  if (status != Z_STREAM_END) return {};
  return content;
}

std::string pack_gzip(std::string_view content) {
  z_stream stream{};
  if (deflateInit2(&stream, 9, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) != Z_OK) std::abort();
  std::string packed(deflateBound(&stream, content.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  if (deflate(&stream, Z_FINISH) != Z_STREAM_END) std::abort();
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

std::optional<std::string> unpack_zstd(std::string_view packed) {
  std::string content(kMaxContent, '\0');
  const std::size_t size =
      ZSTD_decompress(content.data(), kMaxContent, packed.data(), packed.size());
  if (ZSTD_isError(size) != 0) return {};
  content.resize(size);
  return content;
}

std::string pack_zstd(std::string_view content) {
  std::string packed(ZSTD_compressBound(content.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), content.data(), content.size(), 3));
  return packed;
}

/// Compresses content as one part, or as two that follow each other.
std::string pack(std::string_view content, Choices& choices) {
  const auto part = [&](std::string_view bytes) {
    return choices.one_in(2) ? pack_gzip(bytes) : pack_zstd(bytes);
  };
  const bool is_gzip = choices.one_in(2);
  const auto same = [&](std::string_view bytes) {
    return is_gzip ? pack_gzip(bytes) : pack_zstd(bytes);
  };
  if (choices.one_in(2)) return same(content);
  const std::size_t middle = choices.below(content.size() + 1);
  const std::string first = same(content.substr(0, middle));
  const std::string_view rest = content.substr(middle);
  return first + (choices.one_in(8) ? part(rest) : same(rest));
}

}  // namespace
}  // namespace planetree

/// Reads arbitrary bytes as a compressed mesh. Input that names no packing is taken as gzip data
/// without its first bytes. Long inputs are left out, as their content may be very long.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace planetree::octree;
  if (size > 1024) return 0;
  std::string text(reinterpret_cast<const char*>(bytes), size);
  if (packing_of(text) == Packing::kNone) text.insert(0, "\x1f\x8b\x08");
  const planetree::MemoryFile memory(reinterpret_cast<const std::uint8_t*>(text.data()),
                                     text.size());
  CheckingSink sink;
  MeshScratch scratch(std::uint64_t{1} << 20, "/dev/shm");
  const auto summary = read_mesh(memory.path(), sink, scratch);
  // A frame behind the first may need a larger window than there is memory for.
  const bool needs_memory = !summary && summary.error().code == planetree::ErrorCode::kNoMemory;
  if (!needs_memory) sink.check(summary);
  return 0;
}

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

/// Changes the mesh and compresses it again, so that checksums and lengths are right.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  using namespace planetree;
  Choices choices(seed);
  const std::string_view packed(reinterpret_cast<const char*>(data), size);
  std::optional<std::string> content = unpack_gzip(packed);
  if (!content) content = unpack_zstd(packed);
  if (!content || choices.one_in(3)) return LLVMFuzzerMutate(data, size, max_size);
  const std::size_t old_size = content->size();
  content->resize(kMaxContent);
  content->resize(mutate_mesh(kOffGrammar, reinterpret_cast<std::uint8_t*>(content->data()),
                              old_size, kMaxContent, static_cast<unsigned>(choices.next())));
  const std::string again = pack(*content, choices);
  if (again.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::copy(again.begin(), again.end(), data);
  return again.size();
}
