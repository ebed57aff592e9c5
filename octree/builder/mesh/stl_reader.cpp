#include "octree/builder/mesh/stl_reader.h"

#include <bit>
#include <cinttypes>
#include <cstdint>

#include "octree/builder/mesh/ply_scalar.h"
#include "octree/builder/mesh/stream/fan_emitter.h"
#include "octree/builder/mesh/stream/mesh_text.h"
#include "octree/builder/mesh/stream/mesh_window.h"

namespace planetree::octree {

namespace {

constexpr std::uint64_t kCountOffset = 80;
constexpr std::uint64_t kFacetsOffset = 84;
constexpr std::uint64_t kFacetBytes = 50;  ///< normal, three corners, two bytes of attributes
constexpr std::uint64_t kNormalBytes = 12;
constexpr std::uint64_t kCornerBytes = 12;
constexpr bool kSwap = std::endian::native != std::endian::little;

/// `prefix` has at least kFacetsOffset bytes.
std::uint64_t facet_count(std::string_view prefix) {
  return load<std::uint32_t>(reinterpret_cast<const std::byte*>(prefix.data()) + kCountOffset,
                             kSwap);
}

Vec3 corner_position(const std::byte* at) {
  return {static_cast<double>(load<float>(at, kSwap)),
          static_cast<double>(load<float>(at + 4, kSwap)),
          static_cast<double>(load<float>(at + 8, kSwap))};
}

/// The number of facets, checked against the size of the file.
Result<std::uint64_t> checked_count(const MeshFile& file) {
  if (file.size_bytes() < kFacetsOffset) {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, file.size_bytes(),
                      "byte %" PRIu64
                      ": the file ends within the 84 bytes an STL begins with; copy "
                      "or export it again",
                      file.size_bytes());
  }
  const Result<std::string> prefix = file.prefix(kFacetsOffset);
  if (!prefix) return prefix.error();
  const std::uint64_t count = facet_count(*prefix);
  const std::uint64_t space = (file.size_bytes() - kFacetsOffset) / kFacetBytes;
  if (count == space) return count;
  return make_error(ErrorCode::kBadInput, Error::kNowhere, kCountOffset,
                    "byte 80: the count is %" PRIu64 " facets, the file has bytes for %" PRIu64
                    ": %s; copy or export it again",
                    count, space, count > space ? "it is truncated" : "the count is wrong");
}

}  // namespace

bool has_binary_stl_size(std::string_view prefix, std::uint64_t size_bytes) noexcept {
  if (prefix.size() < kFacetsOffset) return false;
  return size_bytes == kFacetsOffset + facet_count(prefix) * kFacetBytes;
}

bool is_ascii_stl(std::string_view file) noexcept {
  constexpr std::size_t kProbeBytes = 512;
  const std::string_view probe = file.substr(0, kProbeBytes);
  std::string_view rest = probe;
  return is_same_word(take_word(rest), "solid") && probe.find('\0') == std::string_view::npos;
}

Result<MeshSummary> read_stl_binary(const MeshFile& file, TriangleSink& sink) {
  const Result<std::uint64_t> count = checked_count(file);
  if (!count) return count.error();
  FanEmitter emitter(sink, RecordKind::kFacet, file.size_bytes());
  emitter.set_vertex_count(3 * *count);
  MeshWindow window(file);
  for (std::uint64_t facet = 0; facet < *count; ++facet) {
    const std::uint64_t offset = kFacetsOffset + facet * kFacetBytes;
    const std::byte* const record = window.at(offset, kFacetBytes);
    if (record == nullptr) return window.failure();
    const auto corner_at = [record](std::uint64_t k) {
      return MeshCorner{corner_position(record + kNormalBytes + k * kCornerBytes),
                        static_cast<std::int64_t>(k), true};
    };
    if (Result<void> taken = emitter.polygon(facet, 3, corner_at); !taken) return taken.error();
    if (const auto told = emitter.advance(offset + kFacetBytes); !told) return told.error();
  }
  return emitter.finish(true);
}

}  // namespace planetree::octree
