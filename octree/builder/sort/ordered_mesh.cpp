#include "octree/builder/sort/ordered_mesh.h"

#include <cassert>
#include <filesystem>
#include <limits>
#include <span>
#include <utility>

#include "octree/builder/job/input_paths.h"
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

// The file with the triangle index, which exists.
const std::filesystem::path& file_of(std::uint64_t index, const MeshSummary& summary,
                                     std::span<const std::filesystem::path> paths) {
  std::size_t number = 0;
  for (std::uint64_t end = summary.file_indices[0]; end <= index;)
    end += summary.file_indices[++number];
  return paths[number];
}

Error refuse_skipped(const ModelFrame& frame, const MeshSummary& summary, const BuildInput& input,
                     MeshScratch& scratch) {
  if (const auto paths = paths_of(input); !paths.empty())
    scratch.begin_file(file_of(frame.first_skipped, summary, paths));
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "%s; repair the mesh or build without --strict",
                    frame.first_skipped_text.c_str());
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
    return refuse_skipped(*frame, *summary, input, scratch);
  frame->nonplanar_count = summary->odd_polygons.nonplanar;
  frame->first_nonplanar_text = summary->odd_polygons.first_nonplanar;
  frame->fanned_count = summary->odd_polygons.fanned;
  frame->first_fanned_text = summary->odd_polygons.first_fanned;
  const bool wide_ids = summary->triangle_indices > std::numeric_limits<std::uint32_t>::max();
  return OrderedMesh{.frame = *std::move(frame),
                     .vertex_records = summary->vertex_records,
                     .wide_ids = wide_ids,
                     .runs = {},
                     .notes = summary->notes,
                     .attributes = std::move(attributes),
                     .value_kind = summary->value_kind,
                     .file_indices = summary->file_indices};
}

}  // namespace planetree::octree
