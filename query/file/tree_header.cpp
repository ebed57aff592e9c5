#include "query/file/tree_header.h"

#include <cstddef>
#include <cstdint>

#include "octree/page/frame.h"

namespace planetree::query {
namespace {

// The head of a block and one row for each coordinate.
constexpr std::uint64_t kMinBlockSlots = 4;

Error bad_tree(std::size_t offset, const char* cause) noexcept {
  return make_error(ErrorCode::kDamaged, Error::kNowhere,
                    offsetof(storage::FileHeader, model) + offset,
                    "%s; restore the file from a copy or build it again", cause);
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
  return take_slots(slots, nodes, node_slots) && take_slots(slots, blocks, kMinBlockSlots);
}

}  // namespace

Result<void> check_tree_header(const storage::FileHeader& header) noexcept {
  const storage::ModelRecord& model = header.model;
  const std::uint32_t first_cap_page = header.first_cap_page();
  const octree::LinkFormat links(header.page_bytes);
  if (links.page(model.root_link) != 0)
    return bad_tree(offsetof(storage::ModelRecord, root_link),
                    "the tree's root is not on the first page");
  if (!fits(header, first_cap_page, model.node_count, octree::kNodeSlots, model.block_count))
    return bad_tree(offsetof(storage::ModelRecord, node_count),
                    "the header states more nodes and blocks than its pages can hold");
  if (model.cap_count > 0 && links.page(model.cap_root_link) != first_cap_page)
    return bad_tree(offsetof(storage::ModelRecord, cap_root_link),
                    "the root of the caps is not on the first page of caps");
  if (!fits(header, model.cap_page_count, model.cap_node_count,
            octree::kNodeSlots + octree::kMomentSlots, model.cap_block_count))
    return bad_tree(offsetof(storage::ModelRecord, cap_node_count),
                    "the header states more nodes and blocks of caps than its pages can hold");
  return {};
}

}  // namespace planetree::query
