#include "octree/page/mask_streams.h"

#include <cstring>

#include "octree/page/byte_split.h"

namespace planetree::octree {
namespace {

const char* check_head(const MaskPageHead& head) {
  if (head.record_count == 0 || head.root_count == 0) return "the page holds no record";
  if (head.root_count > head.record_count) return "the count of roots does not fit";
  if (std::size_t{head.node_count} + head.plain_count + head.corners_count + head.special_count +
          head.listed_count !=
      head.record_count)
    return "the counts of records do not add up";
  if (head.page_link_count > head.node_count) return "the count of links does not fit";
  if (head.reserved != 0) return "reserved bytes are not 0";
  return nullptr;
}

}  // namespace

const char* MaskStreams::read(std::span<const std::byte> raw, bool float64) noexcept {
  constexpr const char* kShort = "the page is shorter than its counts say";
  if (raw.size() < sizeof head) return kShort;
  std::memcpy(&head, raw.data(), sizeof head);
  if (const char* fault = check_head(head)) return fault;
  StreamReader layout(raw.subspan(sizeof head));
  layout.take(kinds, head.record_count);
  for (auto* masks : {&grey, &leaf, &black, &inverted}) layout.take(*masks, head.node_count);
  layout.take(linked_pages, head.page_link_count);
  layout.take(linked_records, head.page_link_count);
  layout.take(plain_corners, head.plain_count);
  layout.take(corners, 8 * std::size_t{head.corners_count});
  layout.take(plane_counts, head.special_count);
  layout.take(behind, head.special_count);
  layout.take(beyond, head.special_count);
  const std::size_t coordinates = 9 * std::size_t{head.plane_count};
  if (float64)
    layout.take(planes64, coordinates);
  else
    layout.take(planes32, coordinates);
  layout.take(least, head.listed_count);
  layout.take(higher, head.listed_count);
  layout.take(block_counts, head.listed_count);
  layout.take(slab_directions, head.listed_count);
  layout.take(slab_lowers, head.listed_count);
  layout.take(slab_uppers, head.listed_count);
  layout.take(block_octants, head.block_link_count);
  layout.take(block_pages, head.block_link_count);
  layout.take(block_numbers, head.block_link_count);
  if (!layout.has_sufficed()) return kShort;
  return layout.empty() ? nullptr : "the page is longer than its counts say";
}

}  // namespace planetree::octree
