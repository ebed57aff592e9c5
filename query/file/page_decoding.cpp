#include "query/file/page_decoding.h"

#include "octree/page/frame.h"
#include "octree/page/mask_frame.h"
#include "octree/page/page_decoder.h"

namespace planetree::query {

octree::BlockShape block_shape(const storage::ModelRecord& model) noexcept {
  octree::BlockShape shape;
  shape.float64 = model.vertex_kind == storage::VertexKind::kFloat64;
  shape.wide_ids = model.triangle_id_bytes == 8;
  return shape;
}

octree::BlockShape cap_shape(const storage::ModelRecord& model) noexcept {
  octree::BlockShape shape = block_shape(model);
  shape.moments = true;
  return shape;
}

Result<void> decode_frame(const storage::FileHeader& header, const storage::PageEntry& entry,
                          std::uint32_t page, std::span<const std::byte> raw,
                          std::span<std::byte> frame) noexcept {
  const std::uint32_t first_cap_page = header.first_cap_page();
  const std::uint32_t first_mask_page = header.first_mask_page();
  const bool mask = page >= first_mask_page, caps = !mask && page >= first_cap_page;
  octree::PageInfo info;
  info.page_bytes = header.page_bytes;
  info.first_page = mask ? first_mask_page : caps ? first_cap_page : 0;
  const std::uint32_t end = mask ? header.page_count : caps ? first_mask_page : first_cap_page;
  info.page_count = end - info.first_page;
  info.shape = caps ? cap_shape(header.model) : block_shape(header.model);
  info.page_number = page;
  info.octcode = entry.octcode;
  info.ordinal = entry.ordinal;
  return mask ? octree::decode_mask_page(raw, info, frame) : octree::decode_page(raw, info, frame);
}

bool leads_to_pages(const storage::FileHeader& header, std::uint32_t page,
                    std::span<const std::byte> frame) noexcept {
  const std::byte* head = frame.data();
  return page < header.first_mask_page()
             ? reinterpret_cast<const octree::FrameHeader*>(head)->page_link_count > 0
             : reinterpret_cast<const octree::MaskHeader*>(head)->page_link_count > 0;
}

}  // namespace planetree::query
