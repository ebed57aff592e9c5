#include "octree/build/tree_file.h"

#include "octree/build/crown.h"
#include "octree/build/page_appender.h"
#include "octree/build/page_numbers.h"
#include "octree/build/tree_pages.h"
#include "octree/strict_math.h"
#include "storage/page_writer.h"

namespace planetree::octree {
namespace {

void describe_mesh(const BuiltModel& built, storage::ModelRecord& model) {
  const ModelFrame& frame = built.frame;
  model.triangle_count = built.cut.triangle_count;
  model.set_aside_count = frame.set_aside_count;
  model.first_set_aside = frame.first_set_aside;
  model.vertex_count = built.vertex_records;
  const Point centre = frame.centre();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    model.box_lower[axis] = frame.input_lower[axis];
    model.box_upper[axis] = frame.input_upper[axis];
    model.centre[axis] = centre[axis];
    model.sample[axis] = built.cut.sample[axis];
  }
  model.sample_triangle = built.cut.sample_triangle;
  model.scale_exponent = frame.scale_exponent;
  model.vertex_kind =
      built.shape.float64 ? storage::VertexKind::kFloat64 : storage::VertexKind::kFloat32;
  model.triangle_id_bytes = built.shape.wide_ids ? 8 : 4;
  built.edges.describe(frame.scale_exponent, model);
}

void describe_region(const BuiltModel& built, storage::ModelRecord& model) {
  if (!built.box) return;
  model.input_triangles = built.frame.triangle_count;
  const auto& [lower, upper] = *built.box;
  const Point from(lower.x, lower.y, lower.z), to(upper.x, upper.y, upper.z);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    // -0 becomes +0.
    model.region_lower[axis] = from[axis] + 0.0;
    model.region_upper[axis] = to[axis] + 0.0;
  }
  model.region_winding = built.cut.winding;
}

void describe_tree(const BuiltModel& built, const WideTree& crown, storage::ModelRecord& model) {
  model.node_count = crown.nodes.size();
  model.height = crown.nodes.empty() ? built.patches[0].height : crown.nodes[0].height;
  for (const BuiltPatch& patch : built.patches) {
    model.node_count += patch.node_count;
    model.block_count += patch.block_count;
  }
  if (!built.mask) return;
  model.mask_page_count = built.mask->size();
  model.mask_cell_count = built.mask->cell_count();
  model.mask_levels = static_cast<std::uint8_t>(built.mask->levels());
}

}  // namespace

Result<storage::FileHeader> write_tree(const BuiltModel& built, const storage::SpillFile& spilled,
                                       const std::filesystem::path& output,
                                       const BuildOptions& options, storage::FileCalls& calls,
                                       BuildProgress& progress) {
  Crown crown = build_crown(built.above, built.patches, built.shape, options.page_bytes);
  const PageNumbers numbers(crown, built.patches, options.page_bytes);
  if (const auto checked = numbers.check(); !checked) return checked.error();
  const TreePages pages(crown, built.patches, numbers, built.shape, spilled);
  const std::uint32_t mask_pages = built.mask ? built.mask->size() : 0;
  const std::uint32_t page_count = pages.size() + mask_pages;
  auto writer = storage::PageWriter::create(output, page_count, options.replace, calls);
  if (!writer) return writer.error();
  PageAppender appender(*writer, progress, page_count);
  const auto appended =
      appender.append(pages.size(), [&](std::uint32_t page) { return pages.encode(page); });
  if (!appended) return appended.error();
  writer->begin_mask();
  const auto masked = appender.append(
      mask_pages, [&](std::uint32_t page) { return built.mask->encode(page, pages.size()); });
  if (!masked) return masked.error();
  storage::ModelRecord model{};
  describe_mesh(built, model);
  describe_region(built, model);
  describe_tree(built, crown.tree, model);
  model.root_link = pages.root_link();
  return writer->finish(model, options.page_bytes);
}

}  // namespace planetree::octree
