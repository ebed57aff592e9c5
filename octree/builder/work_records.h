#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "octree/builder/cap_tree.h"
#include "octree/builder/job/record_fields.h"
#include "octree/builder/mask/built_mask.h"
#include "octree/builder/mask/mask_sectors.h"
#include "octree/builder/sort/ordered_mesh.h"
#include "octree/builder/surface/edge_balance.h"
#include "octree/builder/surface/region_cut.h"
#include "octree/builder/tree/chunk_build.h"

/// Results of the phases of a build, in the form in which a later build resumes them.
namespace planetree::octree {

/// Result of going through the whole surface.
struct SurfaceWork {
  EdgeBalance edges;
  SurfaceCut cut;
  double openness = 0;                     ///< openness of the whole input
  std::vector<TriangleRuns::Extent> kept;  ///< runs of the triangles that touch a region
  CapWork caps;
};

/// Result of building a chunk.
struct ChunkWork {
  BuiltChunk built;
  MaskSectors::Part part;
};

/// Adds up the parts of a file that records refer to. take() refuses a record that is invalid or
/// that refers to bytes beyond the file.
class SpillExtent {
 public:
  explicit SpillExtent(std::uint64_t file_bytes) : file_bytes_(file_bytes) {}

  bool take(const OrderedMesh& mesh);
  bool take(const SurfaceWork& surface, bool float64);
  bool take(const ChunkWork& chunk, bool float64);
  bool take(std::uint32_t number, const BuiltSector& sector);
  bool take(const SpooledAttributes& attributes, std::uint64_t indices);
  bool take(const std::vector<TriangleRuns::Extent>& runs, std::uint64_t triangles, bool float64);
  bool take(const BuiltChunk& chunk);
  bool take(const std::vector<storage::SpillRuns::Extent>& runs, std::size_t record_bytes);
  /// End of the parts that were taken, and the sum of their lengths.
  std::uint64_t end() const { return end_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  bool take(const std::vector<SpilledPage>& pages, std::size_t head_bytes);
  bool take(const TriangleRuns::Extent& run, std::size_t record_bytes);
  bool take(std::uint64_t offset, std::uint64_t count, std::uint64_t each_bytes);

  std::uint64_t file_bytes_;
  std::uint64_t bytes_ = 0;
  std::uint64_t end_ = 0;
};

template <class Value, class Struct>
concept IsA = std::same_as<std::remove_const_t<Value>, Struct>;

template <class Record, IsA<ModelFrame> Value>
void fields(Record& record, Value& frame) {
  record(frame.triangle_count, frame.float64, frame.scale_exponent, frame.input_lower,
         frame.input_upper, frame.input_core_lower, frame.input_core_upper, frame.stray_count,
         frame.stray_edge, frame.input_sample, frame.sample_triangle, frame.skipped_count,
         frame.first_skipped, frame.first_skipped_text, frame.nonplanar_count,
         frame.first_nonplanar_text, frame.fanned_count, frame.first_fanned_text);
}

template <class Record, IsA<TriangleRuns::Extent> Value>
void fields(Record& record, Value& extent) {
  record(extent.offset, extent.size, extent.marks, extent.group_ends);
}

template <class Record, IsA<SpooledAttributes> Value>
void fields(Record& record, Value& attributes) {
  record(attributes.offsets, attributes.count, attributes.record_bytes);
}

template <class Record, IsA<OrderedMesh> Value>
void fields(Record& record, Value& mesh) {
  record(mesh.frame, mesh.vertex_records, mesh.wide_ids, mesh.runs, mesh.notes, mesh.attributes,
         mesh.value_kind, mesh.file_indices);
}

template <class Record, IsA<UnbalancedEdge> Value>
void fields(Record& record, Value& edge) {
  record(edge.triangle, edge.from, edge.to, edge.along, edge.against);
}

template <class Record, IsA<EdgeBalance> Value>
void fields(Record& record, Value& balance) {
  record(balance.unbalanced_edges, balance.first);
}

template <class Record, IsA<SurfaceCut> Value>
void fields(Record& record, Value& cut) {
  record(cut.triangle_count, cut.sample_triangle, cut.sample, cut.winding);
}

template <class Record, IsA<SurfaceWork> Value>
void fields(Record& record, Value& surface) {
  record(surface.edges, surface.cut, surface.openness, surface.kept, surface.caps);
}

template <class Record, IsA<CapWork> Value>
void fields(Record& record, Value& caps) {
  record(caps.count, caps.area, caps.runs);
}

template <class Record, IsA<SpilledPage> Value>
void fields(Record& record, Value& page) {
  record(page.octcode, page.offset, page.raw_bytes, page.links_at, page.link_count);
}

template <class Record, IsA<FloatBox> Value>
void fields(Record& record, Value& box) {
  record(box.lower, box.upper);
}

template <class Record, IsA<SurfaceSums> Value>
void fields(Record& record, Value& sums) {
  record(sums.vector, sums.first, sums.area, sums.position, sums.second);
}

template <class Record, IsA<BuiltChunk> Value>
void fields(Record& record, Value& chunk) {
  record(chunk.pages, chunk.height, chunk.node_count, chunk.block_count, chunk.min_code,
         chunk.greatest_code, chunk.box, chunk.boxes_below, chunk.area, chunk.sums);
}

template <class Record, IsA<MaskSectors::Rise> Value>
void fields(Record& record, Value& rise) {
  record(rise.sector, rise.corners);
}

template <class Record, IsA<MaskSectors::Part> Value>
void fields(Record& record, Value& part) {
  record(part.rises, part.visitors);
}

template <class Record, IsA<MaskEntry> Value>
void fields(Record& record, Value& entry) {
  record(entry.kind, entry.grey, entry.leaf, entry.black, entry.inverted, entry.first,
         entry.corners);
}

template <class Record, IsA<SpecialCell> Value>
void fields(Record& record, Value& special) {
  record(special.plane_count, special.planes, special.behind, special.beyond);
}

template <class Record, IsA<SectorRoot> Value>
void fields(Record& record, Value& root) {
  record(root.entry, root.special);
}

template <class Record, IsA<BuiltSector> Value>
void fields(Record& record, Value& sector) {
  record(sector.pages, sector.cell_count, sector.levels, sector.root);
}

template <class Record, IsA<ChunkWork> Value>
void fields(Record& record, Value& chunk) {
  record(chunk.built, chunk.part);
}

}  // namespace planetree::octree
