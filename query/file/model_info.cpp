#include "query/file/model_info.h"

#include <cmath>

#include "query/file/open_layers.h"
#include "storage/file/directory_shape.h"

namespace planetree::query {
namespace {

std::uint64_t stored_bytes(const storage::FileHeader& header, storage::PageKind kind) {
  return header.stored_bytes[static_cast<unsigned>(kind)];
}

}  // namespace

ModelInfo describe(const storage::PageFile& file) {
  const storage::FileHeader& header = file.header();
  const storage::ModelRecord& model = header.model;
  ModelInfo info;
  info.triangles = model.triangle_count;
  info.skipped = model.skipped_count;
  info.first_skipped = model.first_skipped;
  info.vertices = model.vertex_count;
  info.box_lower = {model.box_lower[0], model.box_lower[1], model.box_lower[2]};
  info.box_upper = {model.box_upper[0], model.box_upper[1], model.box_upper[2]};
  info.core_lower = {model.core_lower[0], model.core_lower[1], model.core_lower[2]};
  info.core_upper = {model.core_upper[0], model.core_upper[1], model.core_upper[2]};
  info.strays = model.stray_count;
  info.unbalanced_edges = model.unbalanced_edge_count;
  info.caps = model.cap_count;
  info.cap_area = std::ldexp(model.cap_area, -2 * model.scale_exponent);
  info.side_rule =
      model.side_rule == storage::SideRule::kSurface ? SideRule::kSurface : SideRule::kSolid;
  info.side_is_chosen = model.side_is_chosen != 0;
  info.openness = model.openness;
  info.input_triangles = model.usable_triangles();
  info.has_region = model.has_region();
  info.region_lower = {model.region_lower[0], model.region_lower[1], model.region_lower[2]};
  info.region_upper = {model.region_upper[0], model.region_upper[1], model.region_upper[2]};
  info.float64 = model.vertex_kind == storage::VertexKind::kFloat64;
  info.nodes = model.node_count;
  info.blocks = model.block_count;
  info.levels = model.height;
  info.layers = layers_of(model);
  info.attributes = model.attributes;
  info.value_kind = static_cast<ValueKind>(model.value_kind);
  info.pages = header.page_count;
  info.page_bytes = header.page_bytes;
  info.file_bytes = header.file_bytes;
  info.section_bytes.headers = 2 * sizeof header;
  info.section_bytes.extensions = header.file_bytes - storage::kHeaderBytes -
                                  storage::pages_end(header) +
                                  header.extension_count * sizeof(storage::ExtensionRecord);
  info.section_bytes.directory = storage::DirectoryShape(header.page_count).bytes();
  info.section_bytes.distance_pages = stored_bytes(header, storage::PageKind::kDistance);
  info.section_bytes.cap_pages = stored_bytes(header, storage::PageKind::kCaps);
  info.section_bytes.field_pages = stored_bytes(header, storage::PageKind::kField);
  info.section_bytes.attribute_pages = stored_bytes(header, storage::PageKind::kAttributes);
  info.section_bytes.mask_pages = stored_bytes(header, storage::PageKind::kMask);
  info.content_id[0] = header.content_id[0];
  info.content_id[1] = header.content_id[1];
  return info;
}

}  // namespace planetree::query
