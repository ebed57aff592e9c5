#include "query/file/page_decoding.h"

#include <algorithm>

#include "octree/field/field_page.h"
#include "octree/page/frame.h"
#include "octree/page/mask_frame.h"
#include "octree/page/page_decoder.h"

namespace planetree::query {

// The file's rules for fields are those of the field.
static_assert(storage::kMaxFieldPoints == octree::FieldShape::kMaxPoints);
static_assert(storage::kMinPageBytes / storage::kFieldPointShare ==
              octree::points_per_field_page(storage::kMinPageBytes));

octree::BlockShape block_shape(const storage::FileHeader& header) noexcept {
  octree::BlockShape shape;
  shape.float64 = header.model.vertex_kind == storage::VertexKind::kFloat64;
  shape.wide_ids = header.model.triangle_id_bytes == 8;
  shape.links = octree::LinkFormat::of_pages(header.page_bytes, header.first_field_page()).target();
  return shape;
}

octree::BlockShape cap_shape(const storage::FileHeader& header) noexcept {
  octree::BlockShape shape = block_shape(header);
  shape.moments = true;
  return shape;
}

octree::FieldShape field_shape(const storage::ModelRecord& model) noexcept {
  octree::FieldShape shape;
  for (unsigned axis = 0; axis < 3; ++axis) {
    shape.lower[axis] = model.field_lower[axis];
    shape.size[axis] = model.field_size[axis];
  }
  shape.step = model.field_step;
  shape.quantum = model.field_quantum;
  return shape;
}

std::size_t field_points(const storage::FileHeader& header, std::uint32_t page) noexcept {
  const std::uint64_t in_page = octree::points_per_field_page(header.page_bytes);
  const std::uint64_t before = in_page * (page - header.first_field_page());
  return static_cast<std::size_t>(std::min(in_page, field_shape(header.model).count() - before));
}

// The bits and sizes of the file are those of the pages.
static_assert(storage::kAttributeLinks == kKeepTriangles);
static_assert(storage::kAttributeColors == kKeepColor);
static_assert(storage::kAttributeUvs == kKeepUv);
static_assert(storage::kAttributeValues == kKeepValue);
static_assert(storage::kAttributeHeadBytes == octree::AttributeShape::kHeadBytes);

octree::AttributeShape attribute_shape(const storage::ModelRecord& model) noexcept {
  return {model.attributes};
}

std::uint32_t attribute_triangles(const storage::FileHeader& header, std::uint32_t page) noexcept {
  // Of the shape that is decoded, which has links even where a damaged header says otherwise.
  const std::uint64_t in_page = attribute_shape(header.model).triangles_per_page(header.page_bytes);
  const std::uint64_t before = in_page * (page - header.first_attribute_page());
  return static_cast<std::uint32_t>(std::min(in_page, header.model.index_count() - before));
}

octree::PageInfo page_info(const storage::FileHeader& header, const storage::PageEntry& entry,
                           std::uint32_t page) noexcept {
  const std::uint32_t starts[] = {0,
                                  header.first_cap_page(),
                                  header.first_field_page(),
                                  header.first_attribute_page(),
                                  header.first_mask_page(),
                                  header.page_count};
  constexpr unsigned kCaps = 1, kAttributes = 3;
  unsigned section = 0;
  while (page >= starts[section + 1]) ++section;
  octree::PageInfo info;
  info.page_bytes = header.page_bytes;
  info.first_page = starts[section];
  info.page_count = starts[section + 1] - starts[section];
  info.tree_pages = section == kAttributes ? header.first_cap_page() : header.first_field_page();
  info.shape = section == kCaps ? cap_shape(header) : block_shape(header);
  info.page_number = page;
  info.octcode = entry.octcode;
  return info;
}

Result<void> decode_frame(const storage::FileHeader& header, const octree::PageInfo& info,
                          std::span<const std::byte> raw, std::span<std::byte> frame) noexcept {
  const std::uint32_t page = info.page_number;
  if (page >= header.first_mask_page()) return octree::decode_mask_page(raw, info, frame);
  if (page < header.first_field_page()) return octree::decode_page(raw, info, frame);
  if (page >= header.first_attribute_page())
    return octree::decode_attribute_page(raw, info, attribute_shape(header.model),
                                         attribute_triangles(header, page), frame);
  return octree::decode_field_page(
      raw, info, {reinterpret_cast<octree::FieldPoint*>(frame.data()), field_points(header, page)});
}

bool leads_to_pages(const storage::FileHeader& header, std::uint32_t page,
                    std::span<const std::byte> frame) noexcept {
  const std::byte* head = frame.data();
  if (page >= header.first_field_page() && page < header.first_mask_page()) return false;
  return page < header.first_mask_page()
             ? reinterpret_cast<const octree::FrameHeader*>(head)->page_link_count > 0
             : reinterpret_cast<const octree::MaskHeader*>(head)->page_link_count > 0;
}

}  // namespace planetree::query
