#include "query/file/tree_header.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "octree/page/frame.h"
#include "octree/page/mask_frame.h"

namespace planetree::query {
namespace {

Error bad_tree(std::size_t offset, const char* cause) noexcept {
  return make_error(ErrorCode::kDamaged, Error::kNowhere,
                    offsetof(storage::FileHeader, model) + offset,
                    "%s; restore the file from a copy or build it again", cause);
}

Error too_many(std::uint32_t pages, const storage::FileHeader& header) noexcept {
  return make_error(
      ErrorCode::kUnsupported, Error::kNowhere, offsetof(storage::FileHeader, page_count),
      "%u pages of %u bytes are more than this program can link; build the file again "
      "with pages of %u bytes, which waste less, or in parts",
      pages, header.page_bytes, storage::kMaxPageBytes);
}

// Returns whether so many records of this size fit into `slots`, and takes them away.
bool take_slots(std::uint64_t& slots, std::uint64_t records, std::uint64_t record_slots) {
  if (records > slots / record_slots) return false;
  slots -= records * record_slots;
  return true;
}

// Returns whether so many nodes and blocks fit into a number of pages.
bool fits(const storage::FileHeader& header, std::uint32_t pages, std::uint64_t nodes,
          unsigned node_slots, std::uint64_t blocks) {
  std::uint64_t slots = std::uint64_t{pages} * (header.page_bytes / octree::kSlotBytes);
  return take_slots(slots, nodes, node_slots) && take_slots(slots, blocks, octree::kMinBlockSlots);
}

}  // namespace

Result<void> check_page_limits(const storage::FileHeader& header) noexcept {
  const std::uint32_t page_bytes = header.page_bytes;
  const std::uint32_t tree_pages = std::min(header.first_field_page(), header.page_count);
  const std::uint32_t mask_pages = header.model.mask_page_count;
  if (tree_pages > octree::LinkFormat::numbered(page_bytes).max_pages())
    return too_many(tree_pages, header);
  if (mask_pages > octree::MaskLinkFormat(page_bytes).max_pages())
    return too_many(mask_pages, header);
  return {};
}

Result<void> check_tree_header(const storage::FileHeader& header) noexcept {
  const storage::ModelRecord& model = header.model;
  if (const auto checked = check_page_limits(header); !checked) return checked;
  if (!fits(header, header.first_cap_page(), model.node_count, octree::kNodeSlots,
            model.block_count))
    return bad_tree(offsetof(storage::ModelRecord, node_count),
                    "the header states more nodes and blocks than its pages can hold");
  if (!fits(header, model.cap_page_count, model.cap_node_count,
            octree::kNodeSlots + octree::kMomentSlots, model.cap_block_count))
    return bad_tree(offsetof(storage::ModelRecord, cap_node_count),
                    "the header states more nodes and blocks of caps than its pages can hold");
  return {};
}

}  // namespace planetree::query
