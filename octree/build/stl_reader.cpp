#include "octree/build/stl_reader.h"

#include <bit>
#include <cinttypes>
#include <cstdint>

#include "octree/build/mesh_delivery.h"
#include "octree/build/mesh_text.h"
#include "octree/build/ply_scalar.h"

namespace planetree::octree {

namespace {

constexpr std::uint64_t kCountOffset = 80;
constexpr std::uint64_t kFacetsOffset = 84;
constexpr std::uint64_t kFacetBytes = 50;  ///< normal, three corners, two bytes of attributes
constexpr std::uint64_t kNormalBytes = 12;
constexpr std::uint64_t kCornerBytes = 12;
constexpr bool kSwap = std::endian::native != std::endian::little;

std::uint64_t facet_count(const std::byte* file) {
  return load<std::uint32_t>(file + kCountOffset, kSwap);
}

Vec3 corner_position(const std::byte* at) {
  return {static_cast<double>(load<float>(at, kSwap)),
          static_cast<double>(load<float>(at + 4, kSwap)),
          static_cast<double>(load<float>(at + 8, kSwap))};
}

Result<void> check_size(const MeshFile& file) {
  if (file.size_bytes() < kFacetsOffset) {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, file.size_bytes(),
                      "byte %" PRIu64
                      ": the file ends within the 84 bytes an STL begins with; copy "
                      "or export it again",
                      file.size_bytes());
  }
  const std::uint64_t count = facet_count(file.bytes());
  const std::uint64_t room = (file.size_bytes() - kFacetsOffset) / kFacetBytes;
  if (count == room) return {};
  return make_error(ErrorCode::kBadInput, Error::kNowhere, kCountOffset,
                    "byte 80: the count says %" PRIu64 " facets, the file has room for %" PRIu64
                    ": %s; copy or export it again",
                    count, room, count > room ? "it is truncated" : "the count lies");
}

}  // namespace

bool has_binary_stl_size(std::string_view file) noexcept {
  if (file.size() < kFacetsOffset) return false;
  const std::uint64_t count = facet_count(reinterpret_cast<const std::byte*>(file.data()));
  return file.size() == kFacetsOffset + count * kFacetBytes;
}

bool is_ascii_stl(std::string_view file) noexcept {
  constexpr std::size_t kProbeBytes = 512;
  const std::string_view probe = file.substr(0, kProbeBytes);
  std::string_view rest = probe;
  return is_same_word(take_word(rest), "solid") && probe.find('\0') == std::string_view::npos;
}

Result<MeshSummary> read_stl_binary(MeshFile& file, TriangleSink& sink) {
  if (Result<void> size = check_size(file); !size) return size.error();
  const std::uint64_t count = facet_count(file.bytes());
  MeshDelivery delivery(sink, RecordKind::kFacet, file.size_bytes());
  delivery.set_vertex_count(3 * count);
  for (std::uint64_t facet = 0; facet < count; ++facet) {
    const std::uint64_t offset = kFacetsOffset + facet * kFacetBytes;
    file.touch(offset);
    const std::byte* const corners = file.bytes() + offset + kNormalBytes;
    const auto corner_at = [corners](std::uint64_t k) {
      return MeshCorner{corner_position(corners + k * kCornerBytes), static_cast<std::int64_t>(k),
                        true};
    };
    if (Result<void> taken = delivery.polygon(facet, 3, corner_at); !taken) return taken.error();
    delivery.advance(offset + kFacetBytes);
  }
  return delivery.finish(true);
}

}  // namespace planetree::octree
