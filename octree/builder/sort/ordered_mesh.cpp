#include "octree/builder/sort/ordered_mesh.h"

#include <cassert>
#include <limits>
#include <utility>

#include "octree/builder/mesh/mesh_reader.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

Result<MeshSummary> read(const BuildInput& input, const BuildOptions& options, MeshScratch& scratch,
                         FrameSink& sink, storage::SpillFile& kept, SpooledAttributes& attributes) {
  const MeshOptions how{.float64 = options.float64,
                        .keep = options.keep & ~kKeepTriangles,
                        .value_property = options.value_property};
  if (how.keep == 0) return read_mesh(input, sink, scratch, how);
  AttributeSpool both(AttributeShape{how.keep}, sink, kept);
  Result<MeshSummary> summary = read_mesh(input, both, scratch, how);
  if (!summary) return summary;
  auto spooled = both.finish();
  if (!spooled) return spooled.error();
  assert(spooled->count == summary->triangle_indices);
  attributes = *std::move(spooled);
  return summary;
}

}  // namespace

Result<OrderedMesh> read_unordered(const BuildInput& input, const BuildOptions& options,
                                   MeshScratch& scratch, BuildProgress& progress, FrameSink& sink,
                                   storage::SpillFile& kept) {
  sink.report_to(progress);
  SpooledAttributes attributes;
  const Result<MeshSummary> summary = read(input, options, scratch, sink, kept, attributes);
  if (!summary) return summary.error();
  auto frame = sink.finish();
  if (!frame) return frame.error();
  if (options.strict && frame->skipped_count > 0)
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "%s; repair the mesh or build without --strict",
                      frame->first_skipped_text.c_str());
  frame->nonplanar_count = summary->odd_polygons.nonplanar;
  frame->first_nonplanar_text = summary->odd_polygons.first_nonplanar;
  frame->fanned_count = summary->odd_polygons.fanned;
  frame->first_fanned_text = summary->odd_polygons.first_fanned;
  const bool wide_ids = summary->triangle_indices > std::numeric_limits<std::uint32_t>::max();
  return OrderedMesh{*std::move(frame), summary->vertex_records, wide_ids,           {},
                     summary->notes,    std::move(attributes),   summary->value_kind};
}

}  // namespace planetree::octree
