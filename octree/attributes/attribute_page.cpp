#include "octree/attributes/attribute_page.h"

#include "octree/page/byte_split.h"
#include "octree/page/frame.h"

namespace planetree::octree {
namespace {

/// Copies elements of a split stream side by side.
/// element_bytes  bytes of an element.
void join(std::span<const std::byte> split, std::size_t count, std::size_t element_bytes,
          std::byte* to) {
  for (std::size_t k = 0; k < element_bytes; ++k)
    for (std::size_t i = 0; i < count; ++i) to[i * element_bytes + k] = split[k * count + i];
}

/// Writes the links of all triangles to `links`. Returns null, or a fault.
const char* decode_links(ByteSplit<std::uint32_t> pages, ByteSplit<std::uint16_t> numbers,
                         const PageInfo& info, std::byte* links) {
  const LinkFormat format = LinkFormat::numbered(info.page_bytes);
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const StoredLink block = {pages[i], numbers[i]};
    std::uint32_t link = kNoLink;
    if (block != kNoStoredLink) {
      if (block.page >= info.tree_pages || block.record >= max_page_blocks(info.page_bytes))
        return "a link does not lead to a block of the tree";
      link = format.make_block(block);
    }
    std::memcpy(links + i * sizeof link, &link, sizeof link);
  }
  return nullptr;
}

const char* check_head(const AttributePageHead& head, const PageInfo& info, std::uint32_t count) {
  if (const char* const fault = fault_of_key(head, info)) return fault;
  if (head.octcode != 0 || head.ordinal != info.page_number - info.first_page)
    return "its key is not that of its triangles";
  if (head.triangle_count != count) return "it has not as many triangles as it should have";
  return head.reserved == 0 ? nullptr : "reserved bytes are not 0";
}

const char* decode(std::span<const std::byte> raw, const PageInfo& info, AttributeShape shape,
                   std::uint32_t count, std::span<std::byte> frame) {
  AttributePageHead head;
  if (raw.size() < sizeof head) return "the page is shorter than its head";
  std::memcpy(&head, raw.data(), sizeof head);
  if (const char* const fault = check_head(head, info, count)) return fault;
  StreamReader layout(raw.subspan(sizeof head));
  ByteSplit<std::uint32_t> block_pages;
  ByteSplit<std::uint16_t> block_numbers;
  layout.take(block_pages, count);
  layout.take(block_numbers, count);
  const auto colors =
      layout.take_bytes(shape.has_colors() ? count * AttributeShape::kColorBytes : 0);
  const auto uvs = layout.take_bytes(shape.has_uvs() ? count * AttributeShape::kUvBytes : 0);
  const auto values =
      layout.take_bytes(shape.has_values() ? count * AttributeShape::kValueBytes : 0);
  if (!layout.has_sufficed()) return "the page is shorter than its counts say";
  if (!layout.empty()) return "the page is longer than its counts say";
  std::memset(frame.data(), 0, AttributeShape::kHeadBytes);
  std::memcpy(frame.data(), &head, sizeof head);
  if (shape.has_colors())
    join(colors, count, AttributeShape::kColorBytes,
         frame.data() + AttributeView::colors_at(shape, count));
  // Each float and each value is split by itself.
  if (shape.has_uvs())
    join(uvs, std::size_t{6} * count, sizeof(float),
         frame.data() + AttributeView::uvs_at(shape, count));
  if (shape.has_values())
    join(values, count, AttributeShape::kValueBytes, frame.data() + AttributeShape::kHeadBytes);
  return decode_links(block_pages, block_numbers, info,
                      frame.data() + AttributeView::links_at(shape, count));
}

}  // namespace

Result<void> decode_attribute_page(std::span<const std::byte> raw, const PageInfo& info,
                                   AttributeShape shape, std::uint32_t count,
                                   std::span<std::byte> frame) noexcept {
  const char* const fault = decode(raw, info, shape, count, frame);
  if (!fault) return {};
  return make_error(ErrorCode::kDamaged, info.page_number, Error::kNowhere,
                    "attribute page %u is damaged: %s; build the file again", info.page_number,
                    fault);
}

}  // namespace planetree::octree
