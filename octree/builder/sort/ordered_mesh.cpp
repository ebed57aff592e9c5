#include "octree/builder/sort/ordered_mesh.h"

#include <limits>
#include <utility>

#include "octree/builder/mesh/mesh_reader.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {

Result<OrderedMesh> read_unordered(const BuildInput& input, const BuildOptions& options,
                                   MeshScratch& scratch, BuildProgress& progress,
                                   TriangleSpool& spool) {
  const auto report = [](void* context, std::uint64_t done, std::uint64_t total) {
    return static_cast<BuildProgress*>(context)->progress(BuildPhase::kReading, done, total);
  };
  spool.report_progress(report, &progress);
  const Result<MeshSummary> summary = read_mesh(input, spool, scratch, {options.float64});
  if (!summary) return summary.error();
  auto frame = spool.finish();
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
  return OrderedMesh{*std::move(frame), summary->vertex_records, wide_ids, {}, summary->notes};
}

}  // namespace planetree::octree
