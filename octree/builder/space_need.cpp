#include "octree/builder/space_need.h"

#include <algorithm>
#include <limits>

#include "octree/attributes/attribute_page.h"

#include "octree/builder/attributes/triangle_links.h"
#include "octree/builder/mesh/stream/corner_sort.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/sort/triangles.h"
#include "octree/builder/surface/edge_balance.h"
#include "storage/file/file_layout.h"
#include "storage/system/device_space.h"

namespace planetree::octree {
namespace {

// One edge that chunks share is expected for this many triangles, and one triangle that touches
// another sector than its own. The most crumpled surfaces at hand have a third as many.
constexpr std::uint64_t kTrianglesPerBorderEdge = 12;
constexpr std::uint64_t kTrianglesPerVisitor = 10;
// Bytes of pages per triangle, without vertices: indices, corners, nodes and the mask. And bytes of
// pages that are nearly empty, however few triangles there are.
constexpr std::uint64_t kPageBytes = 12;
constexpr std::uint64_t kWideIdBytes = 4;
constexpr std::uint64_t kMinPageBytes = 4096;
constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

std::uint64_t excess(std::uint64_t bytes, std::uint64_t held_bytes) {
  return bytes - std::min(bytes, held_bytes);
}

/// Bytes of triangles that are spilled, batch by batch. Where a batch is spilled, less memory was
/// left than it takes, so that up to one batch of memory stays unused.
std::uint64_t spilled_bytes(const MeshSize& size, const BuildMemory& memory,
                            std::uint64_t held_bytes) {
  const std::uint64_t record = Triangles::record_bytes(size.float64);
  const std::uint64_t bytes = size.triangles * record;
  return bytes <= held_bytes ? 0
                             : excess(bytes, excess(held_bytes, memory.batch_triangles * record));
}

// By Euler's formula for a surface without handles, about 2 V - F edges belong to one face only.
std::uint64_t border_edges(const MeshSize& size) {
  return std::min(excess(2 * size.vertices, size.triangles), 3 * size.triangles);
}

/// The caps of a surface. A hole has fewer caps than edges. Of triangles that share no edges, each
/// has one.
MeshSize caps_of(const MeshSize& size) {
  const std::uint64_t edges = border_edges(size);
  return {std::min(edges, size.triangles), edges, size.float64};
}

std::uint64_t edge_bytes(const MeshSize& size, const BuildMemory& memory) {
  const std::uint64_t border = border_edges(size);
  const std::uint64_t matched =
      EdgeCensus::kEdgeBytes * (border + size.triangles / kTrianglesPerBorderEdge);
  // The first round of closing the border leaves two edges in three; of triangles that share no
  // edges, it is the last but one.
  const std::uint64_t closed = 2 * EdgeCensus::kEdgeBytes * border;
  const std::uint64_t caps = Triangles::record_bytes(size.float64) * caps_of(size).triangles;
  return (matched <= memory.edge_bytes ? 0 : matched) + (closed <= memory.cap_bytes ? 0 : closed) +
         (caps <= memory.cap_bytes ? 0 : caps);
}

std::uint64_t visitor_bytes(const MeshSize& size, const BuildMemory& memory) {
  const std::uint64_t bytes = Triangles::record_bytes(size.float64) *
                              (size.triangles / kTrianglesPerVisitor + caps_of(size).triangles);
  return bytes <= memory.visitor_bytes ? 0 : bytes;
}

std::uint64_t position_bytes(const MeshSize& size) {
  return 3 * (size.float64 ? sizeof(double) : sizeof(float));
}

// Of a text, as it is spilled. Texture coordinates of an OBJ are spilled by themselves.
std::uint64_t vertex_bytes(const MeshSize& size) {
  return position_bytes(size) + attribute_bytes(size.attributes);
}

Error too_little(const char* what, std::uint64_t needed, std::uint64_t free, const char* remedy) {
  return make_error(ErrorCode::kNoSpace, Error::kNowhere, Error::kNowhere,
                    "%s may take %llu MiB, and the device has %llu MiB free; %s", what,
                    static_cast<unsigned long long>((needed + kMiB - 1) / kMiB),
                    static_cast<unsigned long long>(free / kMiB), remedy);
}

constexpr const char* kTemporaryRemedy =
    "free some, name a --temp-dir with more space, or give more --memory";

}  // namespace

std::uint64_t SpaceNeed::raw_page_bytes(const MeshSize& size) {
  const std::uint64_t vertex_bytes = position_bytes(size);
  // A vertex is stored in every page that has one of its triangles.
  const std::uint64_t vertices = std::min(size.vertices + size.triangles / 4, 3 * size.triangles);
  const bool wide_ids = size.triangles > std::numeric_limits<std::uint32_t>::max();
  return vertex_bytes * vertices + size.triangles * (kPageBytes + (wide_ids ? kWideIdBytes : 0)) +
         kMinPageBytes;
}

SpaceNeed SpaceNeed::after_cutting(const MeshSize& part, const BuildMemory& memory,
                                   std::uint64_t kept_bytes) {
  const MeshSize caps = caps_of(part);
  const std::uint64_t pages = raw_page_bytes(part) + raw_page_bytes(caps);
  const std::uint64_t to_keep = visitor_bytes(part, memory) + excess(pages, memory.pages_bytes);
  // Stored pages are not longer than raw ones, and each page, of 4 KiB or more, has 40 bytes in the
  // table.
  return {excess(to_keep, kept_bytes), pages + pages / 64 + 2 * storage::kHeaderBytes};
}

SpaceNeed SpaceNeed::after_reading(const MeshSize& size, const BuildMemory& memory,
                                   std::uint64_t kept_bytes, bool matched, bool cut) {
  SpaceNeed need;
  if (!cut) need = after_cutting(size, memory, 0);
  need.temporary_bytes =
      excess(need.temporary_bytes + spilled_bytes(size, memory, memory.runs_bytes), kept_bytes);
  if (size.attributes != 0) {
    const AttributeShape shape{size.attributes};
    need.temporary_bytes += size.triangles * (shape.extra_bytes() + TriangleLinks::kTriangleBytes);
    need.output_bytes += size.triangles * shape.triangle_bytes();
  }
  if (!matched) need.temporary_bytes += edge_bytes(size, memory);
  return need;
}

SpaceNeed SpaceNeed::before_reading(const MeshSize& size, const BuildMemory& memory, bool cut) {
  SpaceNeed need = after_reading(size, memory, 0, false, cut);
  need.temporary_bytes += spilled_bytes(size, memory, memory.spool_bytes);
  need.temporary_bytes += size.unpacked_bytes;
  if (size.is_indexed_text)
    need.temporary_bytes +=
        excess(size.vertices * vertex_bytes(size), MeshScratch::text_bytes(memory.reading_bytes));
  return need;
}

SpaceNeed SpaceNeed::before_sorting(const MeshSize& size, const BuildMemory& memory,
                                    std::uint64_t written_bytes, bool cut) {
  SpaceNeed need = before_reading(size, memory, cut);
  need.temporary_bytes =
      excess(need.temporary_bytes +
                 CornerSort::disk_bytes(3 * size.triangles, !size.float64, size.attributes),
             written_bytes);
  return need;
}

Result<void> SpaceNeed::check(const std::filesystem::path& temporary_directory,
                              const std::filesystem::path& output_directory,
                              storage::FileCalls& calls, BuildDirectory& directory) const {
  const auto temporary = storage::DeviceSpace::of(temporary_directory, calls);
  const auto output = storage::DeviceSpace::of(output_directory, calls);
  constexpr std::uint64_t kUnknown = ~std::uint64_t{0};
  const std::uint64_t temporary_free = temporary.free_bytes.value_or(kUnknown);
  const std::uint64_t output_free = output.free_bytes.value_or(kUnknown);
  if (output_bytes > output_free) {
    directory = BuildDirectory::kOutput;
    return too_little("the output", output_bytes, output_free,
                      "free some, or name an output on another device");
  }
  directory = BuildDirectory::kTemporary;
  if (temporary_bytes > temporary_free)
    return too_little("temporary files", temporary_bytes, temporary_free, kTemporaryRemedy);
  if (temporary_bytes > 0 && temporary.is_same_device(output) &&
      temporary_bytes + output_bytes > output_free)
    return too_little("temporary files and the output", temporary_bytes + output_bytes, output_free,
                      kTemporaryRemedy);
  return {};
}

}  // namespace planetree::octree
