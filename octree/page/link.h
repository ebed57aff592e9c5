#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

/// Links between the records of pages. A file names a record by page and number. In memory a link
/// is 32 bits that lead to the record's place in its frame. format-spec/v1/spec.md, "Links",
/// specifies the stored form.
namespace planetree::octree {

inline constexpr std::size_t kSlotBytes = 64;

/// A link as files have it.
struct StoredLink {
  std::uint32_t page = 0;
  std::uint16_t record = 0;  ///< number of the node, the block or the mask's record in its page
  auto operator<=>(const StoredLink&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Layout of a link, the 32-bit address of a child: [leaf 1][page 31 - s][slot s], where s is
/// log2(page bytes / 64). A *numbered* link has the block's number in its page in place of the
/// slot. Lists of the mask and attribute pages have numbered links.
class LinkFormat {
 public:
  explicit constexpr LinkFormat(std::uint32_t page_bytes)
      : slot_bits_(static_cast<unsigned>(std::countr_zero(page_bytes)) - 6) {}

  static constexpr std::uint32_t kLeafBit = std::uint32_t{1} << 31;
  static constexpr bool is_leaf(std::uint32_t link) { return (link & kLeafBit) != 0; }
  constexpr std::uint32_t page(std::uint32_t link) const {
    return (link & ~kLeafBit) >> slot_bits_;
  }
  constexpr std::uint32_t slot(std::uint32_t link) const { return link & slot_mask(); }
  constexpr std::uint32_t make(bool leaf, std::uint32_t page, std::uint32_t slot) const {
    return (leaf ? kLeafBit : 0) | page << slot_bits_ | slot;
  }
  /// Returns the block's number in its page of a numbered link.
  constexpr std::uint32_t number(std::uint32_t numbered) const { return slot(numbered); }
  /// Returns the numbered link to a block.
  constexpr std::uint32_t make_numbered(StoredLink block) const {
    return make(true, block.page, block.record);
  }
  /// Returns how many pages a link can tell apart.
  constexpr std::uint32_t max_pages() const { return std::uint32_t{1} << (31 - slot_bits_); }

 private:
  constexpr std::uint32_t slot_mask() const { return (std::uint32_t{1} << slot_bits_) - 1; }
  unsigned slot_bits_;
};

/// Number of slots of the smallest block: its head, and a row for each coordinate.
inline constexpr unsigned kMinBlockSlots = 4;

/// Returns a number that the blocks of a page do not exceed.
constexpr std::uint32_t max_page_blocks(std::uint32_t page_bytes) {
  return page_bytes / static_cast<std::uint32_t>(kMinBlockSlots * kSlotBytes);
}

/// Returns the slots of the frame header and of the table of the blocks' slots, 16 bits each.
constexpr unsigned frame_head_slots(std::uint32_t page_bytes) {
  const std::size_t table_bytes = max_page_blocks(page_bytes) * sizeof(std::uint16_t);
  return static_cast<unsigned>(1 + (table_bytes + kSlotBytes - 1) / kSlotBytes);
}

/// Returns the link to the root of a tree, which is record 0 of the tree's first page: a node, or a
/// block if the tree has no node.
constexpr std::uint32_t root_link_of(std::uint32_t page_bytes, std::uint32_t first_page,
                                     std::uint64_t node_count) {
  return LinkFormat(page_bytes).make(node_count == 0, first_page, frame_head_slots(page_bytes));
}

}  // namespace planetree::octree
