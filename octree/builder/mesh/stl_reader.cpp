#include "octree/builder/mesh/stl_reader.h"

#include <algorithm>
#include <cinttypes>
#include <cstdint>
#include <string>
#include <vector>

#include "octree/builder/mesh/stream/fan_emitter.h"
#include "octree/builder/mesh/stream/mesh_text.h"
#include "octree/builder/mesh/stream/mesh_window.h"
#include "octree/builder/mesh/stream/scalar_type.h"

namespace planetree::octree {

namespace {

constexpr std::uint64_t kCountOffset = 80;
constexpr std::uint64_t kFacetsOffset = 84;
constexpr std::uint64_t kFacetBytes = 50;  ///< normal, three corners, two bytes of attributes
constexpr std::uint64_t kAttributeBytes = 2;
constexpr std::uint64_t kNormalBytes = 12;
constexpr std::uint64_t kCornerBytes = 12;
constexpr char kControlZ = '\x1a';

/// `prefix` has at least kFacetsOffset bytes.
std::uint64_t facet_count(std::string_view prefix) {
  return load<std::uint32_t>(reinterpret_cast<const std::byte*>(prefix.data()) + kCountOffset,
                             kSwapLittle);
}

Vec3 corner_position(const std::byte* at) {
  return {static_cast<double>(load<float>(at, kSwapLittle)),
          static_cast<double>(load<float>(at + 4, kSwapLittle)),
          static_cast<double>(load<float>(at + 8, kSwapLittle))};
}

/// Where the facets of a file are.
struct Facets {
  std::uint64_t count = 0;
  bool has_payloads = false;  ///< as many bytes follow each facet as its attribute says
  std::uint64_t surplus = 0;  ///< zero bytes or white space behind the last facet
};

/// Length of a facet and of the bytes that its attribute counts. Zero if it cannot be read.
std::uint64_t facet_bytes(MeshWindow& window, std::uint64_t offset) {
  const std::byte* const at = window.at(offset + kFacetBytes - kAttributeBytes, kAttributeBytes);
  return at == nullptr ? 0 : kFacetBytes + load<std::uint16_t>(at, kSwapLittle);
}

/// Whether facets with payloads fill a file exactly.
Result<bool> payloads_fill(const MeshFile& file, std::uint64_t count) {
  MeshWindow window(file);
  std::uint64_t offset = kFacetsOffset;
  for (std::uint64_t facet = 0; facet < count; ++facet) {
    if (file.size_bytes() - offset < kFacetBytes) return false;
    const std::uint64_t bytes = facet_bytes(window, offset);
    if (bytes == 0) return window.failure();
    if (file.size_bytes() - offset < bytes) return false;
    offset += bytes;
  }
  return offset == file.size_bytes();
}

/// Position of the first byte from `offset` on that is neither zero nor white space; the size of
/// the file if there is none.
Result<std::uint64_t> first_content(const MeshFile& file, std::uint64_t offset) {
  MeshWindow window(file);
  for (; offset < file.size_bytes(); ++offset) {
    const std::byte* const at = window.at(offset, 1);
    if (at == nullptr) return window.failure();
    const char c = static_cast<char>(*at);
    if (c != '\0' && c != kControlZ && !is_space(c)) break;
  }
  return offset;
}

Error wrong_size(const MeshFile& file, std::uint64_t count) {
  const std::uint64_t space = (file.size_bytes() - kFacetsOffset) / kFacetBytes;
  const std::uint64_t end = kFacetsOffset + count * kFacetBytes;
  if (count != space) {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, kCountOffset,
                      "byte 80: the count is %" PRIu64 " facets, the file has bytes for %" PRIu64
                      ": %s; copy or export it again",
                      count, space, count > space ? "it is truncated" : "the count is wrong");
  }
  return make_error(ErrorCode::kBadInput, Error::kNowhere, end,
                    "byte %" PRIu64 ": %" PRIu64 " bytes follow the last of %" PRIu64
                    " facets, and fit no attributes: damaged; export it again",
                    end, file.size_bytes() - end, count);
}

/// Finds out how the facets fill the file.
Result<Facets> find_facets(const MeshFile& file) {
  if (file.size_bytes() < kFacetsOffset) {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, file.size_bytes(),
                      "byte %" PRIu64
                      ": the file ends within the 84 bytes an STL begins with; copy "
                      "or export it again",
                      file.size_bytes());
  }
  const Result<std::string> prefix = file.prefix(kFacetsOffset);
  if (!prefix) return prefix.error();
  Facets facets{facet_count(*prefix)};
  const std::uint64_t end = kFacetsOffset + facets.count * kFacetBytes;
  if (end == file.size_bytes()) return facets;
  if (end > file.size_bytes()) return wrong_size(file, facets.count);
  const Result<bool> fill = payloads_fill(file, facets.count);
  if (!fill) return fill.error();
  facets.has_payloads = *fill;
  if (facets.has_payloads) return facets;
  const Result<std::uint64_t> content = first_content(file, end);
  if (!content) return content.error();
  if (*content < file.size_bytes()) return wrong_size(file, facets.count);
  facets.surplus = file.size_bytes() - end;
  return facets;
}

std::vector<std::string> notes_on(const Facets& facets) {
  if (facets.surplus == 0) return {};
  return {std::to_string(facets.surplus) +
          " zero or blank bytes behind the last facet are not read; if facets are missing, copy or "
          "export the file again"};
}

}  // namespace

bool has_binary_stl_size(std::string_view prefix, std::uint64_t size_bytes) noexcept {
  if (prefix.size() < kFacetsOffset) return false;
  return size_bytes == kFacetsOffset + facet_count(prefix) * kFacetBytes;
}

bool is_ascii_stl(std::string_view file) noexcept {
  constexpr std::size_t kProbeBytes = 512;
  const std::string_view probe = file.substr(0, kProbeBytes);
  std::string_view rest = probe.substr(text_begin(probe).offset);
  return is_same_word(take_word(rest), "solid") && probe.find('\0') == std::string_view::npos;
}

Result<MeshSummary> read_stl_binary(const MeshFile& file, TriangleSink& sink) {
  const Result<Facets> facets = find_facets(file);
  if (!facets) return facets.error();
  FanEmitter emitter(sink, RecordKind::kFacet, file.size_bytes());
  emitter.set_vertex_count(3 * facets->count);
  MeshWindow window(file);
  std::uint64_t offset = kFacetsOffset;
  for (std::uint64_t facet = 0; facet < facets->count; ++facet) {
    // Attributes may have changed since they were added up.
    if (file.size_bytes() - offset < kFacetBytes) return wrong_size(file, facets->count);
    const std::byte* const record = window.at(offset, kFacetBytes);
    if (record == nullptr) return window.failure();
    const auto corner_at = [record](std::uint64_t k) {
      return MeshCorner{corner_position(record + kNormalBytes + k * kCornerBytes),
                        static_cast<std::int64_t>(k), true};
    };
    if (Result<void> taken = emitter.polygon(facet, 3, corner_at); !taken) return taken.error();
    const std::uint64_t bytes = facets->has_payloads ? facet_bytes(window, offset) : kFacetBytes;
    if (bytes == 0) return window.failure();
    offset = std::min(offset + bytes, file.size_bytes());
    if (const auto told = emitter.advance(offset); !told) return told.error();
  }
  Result<MeshSummary> summary = emitter.finish(true);
  if (summary) summary->notes = notes_on(*facets);
  return summary;
}

}  // namespace planetree::octree
