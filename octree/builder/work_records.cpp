#include "octree/builder/work_records.h"

#include <algorithm>

namespace planetree::octree {

bool SpillExtent::take(std::uint64_t offset, std::uint64_t count, std::uint64_t each_bytes) {
  if (offset > file_bytes_ || count > (file_bytes_ - offset) / each_bytes) return false;
  end_ = std::max(end_, offset + count * each_bytes);
  bytes_ += count * each_bytes;
  return true;
}

bool SpillExtent::take(const TriangleRuns::Extent& run, std::size_t record_bytes) {
  if (run.marks.size() != storage::SpillRuns::mark_count(run.size)) return false;
  if (run.group_ends.empty()) return take(run.offset, run.size, record_bytes);
  return run.group_ends.size() == run.marks.size() && std::ranges::is_sorted(run.group_ends) &&
         take(run.offset, run.group_ends.back(), 1);
}

bool SpillExtent::take(const std::vector<storage::SpillRuns::Extent>& runs,
                       std::size_t record_bytes) {
  return std::ranges::all_of(runs, [&](const auto& run) { return take(run, record_bytes); });
}

bool SpillExtent::take(const std::vector<TriangleRuns::Extent>& runs, std::uint64_t triangles,
                       bool float64) {
  std::uint64_t left = triangles;
  for (const TriangleRuns::Extent& run : runs) {
    if (run.size > left || !take(run, Triangles::record_bytes(float64))) return false;
    left -= run.size;
  }
  return left == 0;
}

bool SpillExtent::take(const SpooledAttributes& attributes, std::uint64_t indices) {
  if (attributes.record_bytes == 0) return attributes.count == 0 && attributes.offsets.empty();
  constexpr std::uint64_t kInBlock = SpooledAttributes::kBlockRecords;
  if (attributes.count != indices || attributes.offsets.size() != (indices - 1) / kInBlock + 1)
    return false;
  for (std::uint64_t block = 0; block < attributes.offsets.size(); ++block)
    if (!take(attributes.offsets[static_cast<std::size_t>(block)], attributes.block_records(block),
              attributes.record_bytes))
      return false;
  return true;
}

bool SpillExtent::take(const OrderedMesh& mesh) {
  return mesh.frame.triangle_count > 0 && mesh.value_kind <= ValueKind::kReal &&
         take(mesh.attributes, mesh.frame.triangle_count + mesh.frame.skipped_count) &&
         take(mesh.runs, mesh.frame.triangle_count, mesh.frame.float64);
}

bool SpillExtent::take(const SurfaceWork& surface, bool float64) {
  return take(surface.kept, surface.cut.triangle_count, float64) &&
         take(surface.caps.runs, surface.caps.count, float64);
}

bool SpillExtent::take(const std::vector<SpilledPage>& pages, std::size_t head_bytes) {
  return std::ranges::all_of(pages, [&](const SpilledPage& page) {
    const std::uint64_t links_end = page.links_at + std::uint64_t{page.link_count} * kPageLinkBytes;
    return links_end <= page.raw_bytes && head_bytes <= page.raw_bytes &&
           take(page.offset, page.raw_bytes, 1);
  });
}

bool SpillExtent::take(const BuiltChunk& chunk) {
  return take(chunk.pages, sizeof(PageHead)) && !chunk.pages.empty() && !chunk.boxes_below.empty();
}

bool SpillExtent::take(const ChunkWork& chunk, bool float64) {
  return take(chunk.built) && take(chunk.part.visitors, Triangles::record_bytes(float64));
}

bool SpillExtent::take(std::uint32_t number, const BuiltSector& sector) {
  const MaskEntry& entry = sector.root.entry;
  const bool special = entry.kind == MaskEntry::Kind::kSpecial;
  if (special != sector.root.special.has_value() ||
      (special && sector.root.special->plane_count > kMaxPlanes))
    return false;
  const bool divided = entry.kind == MaskEntry::Kind::kSector;
  if (divided && (entry.first != number || sector.pages.empty())) return false;
  return (divided || entry.is_leaf()) && take(sector.pages, sizeof(MaskPageHead));
}

}  // namespace planetree::octree
