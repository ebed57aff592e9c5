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

}  // namespace

Result<void> check_tree_header(const storage::FileHeader& header) noexcept {
  const storage::ModelRecord& model = header.model;
  if (octree::LinkFormat(header.page_bytes).page(model.root_link) != 0)
    return bad_tree(offsetof(storage::ModelRecord, root_link),
                    "the tree's root is not on the first page");
  std::uint64_t slots =
      std::uint64_t{header.first_mask_page()} * (header.page_bytes / octree::kSlotBytes);
  if (!take_slots(slots, model.node_count, octree::kNodeSlots) ||
      !take_slots(slots, model.block_count, kMinBlockSlots))
    return bad_tree(offsetof(storage::ModelRecord, node_count),
                    "the header states more nodes and blocks than its pages can hold");
  return {};
}

}  // namespace planetree::query
