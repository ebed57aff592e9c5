#include "octree/builder/tree_file.h"

#include <limits>
#include <optional>
#include <utility>

#include "octree/builder/mask/height_field_marks.h"
#include "octree/builder/model_members.h"
#include "octree/builder/tree/page_appender.h"
#include "octree/geometry/area_sums.h"
#include "octree/geometry/strict_math.h"
#include "storage/file/metadata.h"
#include "storage/file/page_writer.h"

namespace planetree::octree {
namespace {

void describe_mesh(const BuiltModel& built, storage::ModelRecord& model) {
  const ModelFrame& frame = built.frame;
  model.triangle_count = built.cut.triangle_count;
  model.skipped_count = frame.skipped_count;
  model.first_skipped = frame.first_skipped;
  model.vertex_count = built.vertex_records;
  const Point centre = frame.centre();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    model.box_lower[axis] = frame.input_lower[axis];
    model.box_upper[axis] = frame.input_upper[axis];
    model.centre[axis] = centre[axis];
    model.core_lower[axis] = frame.input_core_lower[axis];
    model.core_upper[axis] = frame.input_core_upper[axis];
    model.sample[axis] = built.cut.sample[axis];
  }
  model.stray_count = frame.stray_count;
  model.stray_edge = frame.stray_edge;
  model.sample_triangle = built.cut.sample_triangle;
  model.scale_exponent = frame.scale_exponent;
  model.vertex_kind =
      built.shape.float64 ? storage::VertexKind::kFloat64 : storage::VertexKind::kFloat32;
  model.triangle_id_bytes = built.shape.wide_ids ? 8 : 4;
  built.edges.describe(frame.scale_exponent, model);
}

void describe_region(const BuiltModel& built, const BuildOptions& options,
                     storage::ModelRecord& model) {
  if (!built.box) return;
  model.input_triangles = built.frame.triangle_count;
  const auto& [lower, upper] = *built.box;
  const Point from(lower.x, lower.y, lower.z), to(upper.x, upper.y, upper.z);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    // Adding 0 turns -0 into +0.
    model.region_lower[axis] = from[axis] + 0.0;
    model.region_upper[axis] = to[axis] + 0.0;
  }
  model.region_winding = options.has_side_layer() ? built.cut.winding : 0;
}

// A surface without a border is not a sheet, whatever the rounding of its openness.
void describe_side_rule(const BuiltModel& built, const BuildOptions& options,
                        storage::ModelRecord& model) {
  const bool is_sheet =
      built.edges.unbalanced_edges > 0 && built.openness >= AreaSums::kOpennessOfSheet;
  model.openness = built.edges.unbalanced_edges > 0 ? built.openness : 0;
  model.side_is_chosen = options.side ? 1 : 0;
  model.without_sides = options.has_side_layer() ? 0 : 1;
  model.side_rule =
      options.side.value_or(is_sheet ? storage::SideRule::kSurface : storage::SideRule::kSolid);
}

void describe_tree(const BuiltModel& built, const BuiltTree& tree, storage::ModelRecord& model) {
  model.node_count = tree.node_count();
  model.block_count = tree.block_count();
  model.height = static_cast<std::uint8_t>(tree.height());
  if (!built.mask) return;
  model.mask_page_count = built.mask->size();
  model.mask_cell_count = built.mask->cell_count();
  model.mask_levels = static_cast<std::uint8_t>(built.mask->levels());
}

storage::ModelRecord describe(const BuiltModel& built, const BuiltTree& tree, const CapTree& caps,
                              const BuildOptions& options) {
  storage::ModelRecord model{};
  describe_mesh(built, model);
  describe_region(built, options, model);
  describe_side_rule(built, options, model);
  describe_tree(built, tree, model);
  caps.describe(model);
  built.field.describe(model);
  built.attributes.describe(options.page_bytes, model);
  return model;
}

/// others  number of all other pages of the file.
Result<std::uint32_t> count_attribute_pages(const BuiltModel& built, std::uint32_t others,
                                            const BuildOptions& options) {
  const std::uint64_t count = built.attributes.page_count(options.page_bytes);
  if (count <= std::numeric_limits<std::uint32_t>::max() - others)
    return static_cast<std::uint32_t>(count);
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "%llu pages of attributes, more than a file has; build with a larger page size",
                    static_cast<unsigned long long>(count));
}

}  // namespace

Result<storage::FileHeader> write_tree(const BuiltModel& built, const BuiltTree& tree,
                                       const CapTree& caps, const std::filesystem::path& output,
                                       const BuildOptions& options, storage::FileCalls& calls,
                                       storage::SpillFile& scratch, BuildProgress& progress) {
  const TreePages& pages = tree.pages();
  const std::uint32_t mask_pages = built.mask ? built.mask->size() : 0;
  const BuiltTrees trees(&tree, caps.tree());
  const std::uint32_t first_attribute_page = trees.page_count() + built.field.page_count();
  const auto attribute_pages =
      count_attribute_pages(built, first_attribute_page + mask_pages, options);
  if (!attribute_pages) return attribute_pages.error();
  const std::uint32_t first_mask_page = first_attribute_page + *attribute_pages;
  const std::uint32_t page_count = first_mask_page + mask_pages;
  auto destination = create_output({built.frame, pages, page_count}, output, options, calls);
  if (!destination) return destination.error();
  auto writer = storage::PageWriter::create(*std::move(destination), page_count,
                                            storage::extensions_of(options.metadata));
  if (!writer) return writer.error();
  PageAppender appender(*writer, progress, page_count);
  // Triangles beyond a wall may touch the lines that prove a height field.
  const bool has_walls = built.box && built.box->region(built.frame).has_walls();
  std::optional<HeightFieldMarks> height_fields;
  if (built.mask && !has_walls) height_fields.emplace(trees, *built.mask);
  std::optional<TriangleLinks> links;
  if (*attribute_pages > 0)
    links.emplace(built.attributes.index_count,
                  built.attributes.shape.triangles_per_page(options.page_bytes), built.shape,
                  options.page_bytes, scratch);
  const auto appended = appender.append(pages.size(), [&](std::uint32_t number) {
    auto page = pages.encode(number);
    if (page && links)
      if (const auto linked = links->add(number, page->bytes); !linked) page = linked.error();
    if (page && height_fields)
      if (const auto marked = height_fields->mark(number, *page); !marked) page = marked.error();
    return page;
  });
  if (!appended) return appended.error();
  if (trees.caps) {
    writer->begin_caps();
    const TreePages& cap_pages = trees.caps->pages();
    const auto capped = appender.append(cap_pages.size(), [&](std::uint32_t page) {
      return cap_pages.encode(cap_pages.first() + page);
    });
    if (!capped) return capped.error();
  }
  writer->begin_field();
  const auto added = appender.append(built.field.page_count(), [&](std::uint32_t page) {
    return Result<FilePage>(built.field.encode(page, trees.page_count()));
  });
  if (!added) return added.error();
  if (links) {
    writer->begin_attributes();
    AttributePages attributes(built.attributes, *links, options.page_bytes);
    if (const auto kept = attributes.append_to(appender, first_attribute_page); !kept)
      return kept.error();
  }
  writer->begin_mask();
  const auto masked = appender.append(
      mask_pages, [&](std::uint32_t page) { return built.mask->encode(page, first_mask_page); });
  if (!masked) return masked.error();
  return writer->finish(describe(built, tree, caps, options), options.page_bytes);
}

}  // namespace planetree::octree
