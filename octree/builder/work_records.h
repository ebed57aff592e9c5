#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "octree/builder/job/record_fields.h"
#include "octree/builder/mask/built_mask.h"
#include "octree/builder/mask/mask_sectors.h"
#include "octree/builder/sort/ordered_mesh.h"
#include "octree/builder/surface/edge_balance.h"
#include "octree/builder/surface/region_cut.h"
#include "octree/builder/tree/chunk_build.h"

/// What the phases of a build come to, as a later build may go on with it.
namespace planetree::octree {

/// What looking at the whole surface gave.
struct SurfaceWork {
  EdgeBalance edges;
  SurfaceCut cut;
  std::vector<TriangleRuns::Place> kept;  ///< of a region: what touches it
};

/// What building a patch gave.
struct PatchWork {
  BuiltPatch built;
  MaskRegions::Part part;  ///< of watertight models
};

/// How far the bytes go that records speak of; what reaches beyond the file is refused.
class SpillExtent {
 public:
  explicit SpillExtent(std::uint64_t file_bytes) : file_bytes_(file_bytes) {}

  bool take(const OrderedMesh& mesh);
  bool take(const SurfaceWork& surface, bool float64);
  bool take(const PatchWork& patch, bool float64, const LinkFormat& links);
  bool take(std::uint32_t number, const BuiltRegion& region, const MaskLinkFormat& links);
  /// Of what was taken: where it ends, and how much it is.
  std::uint64_t end() const { return end_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  bool take(const std::vector<SpilledPage>& pages, std::size_t head_bytes);
  bool take(const std::vector<TriangleRuns::Place>& runs, std::uint64_t triangles, bool float64);
  bool take(const TriangleRuns::Place& run, bool float64);
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
         frame.input_upper, frame.input_sample, frame.sample_triangle, frame.set_aside_count,
         frame.first_set_aside, frame.first_set_aside_text);
}

template <class Record, IsA<TriangleRuns::Place> Value>
void fields(Record& record, Value& place) {
  record(place.offset, place.size, place.marks);
}

template <class Record, IsA<OrderedMesh> Value>
void fields(Record& record, Value& mesh) {
  record(mesh.frame, mesh.vertex_records, mesh.wide_ids, mesh.runs);
}

template <class Record, IsA<OpenEdge> Value>
void fields(Record& record, Value& edge) {
  record(edge.triangle, edge.from, edge.to, edge.along, edge.against);
}

template <class Record, IsA<EdgeBalance> Value>
void fields(Record& record, Value& balance) {
  record(balance.open_edges, balance.first);
}

template <class Record, IsA<SurfaceCut> Value>
void fields(Record& record, Value& cut) {
  record(cut.triangle_count, cut.sample_triangle, cut.sample, cut.winding);
}

template <class Record, IsA<SurfaceWork> Value>
void fields(Record& record, Value& surface) {
  record(surface.edges, surface.cut, surface.kept);
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
  record(sums.vector, sums.first, sums.area, sums.place, sums.second);
}

template <class Record, IsA<BuiltPatch> Value>
void fields(Record& record, Value& patch) {
  record(patch.pages, patch.root_link, patch.height, patch.node_count, patch.block_count,
         patch.least_code, patch.greatest_code, patch.box, patch.boxes_below, patch.area,
         patch.sums);
}

template <class Record, IsA<MaskRegions::Rise> Value>
void fields(Record& record, Value& rise) {
  record(rise.region, rise.corners);
}

template <class Record, IsA<MaskRegions::Part> Value>
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

template <class Record, IsA<RegionRoot> Value>
void fields(Record& record, Value& root) {
  record(root.entry, root.special);
}

template <class Record, IsA<BuiltRegion> Value>
void fields(Record& record, Value& region) {
  record(region.pages, region.family, region.cell_count, region.levels, region.root);
}

template <class Record, IsA<PatchWork> Value>
void fields(Record& record, Value& patch) {
  record(patch.built, patch.part);
}

}  // namespace planetree::octree
