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

/// What a link has behind the page.
enum class LinkTarget : std::uint8_t {
  kSlot,    ///< the record's slot: the record is found at once
  kNumber,  ///< the record's number in its page: fewer bits, so that there may be more pages
};

/// Layout of a link, the 32-bit address of a child: [leaf 1][page 31 - s][slot s], where s is
/// log2(page bytes / 64), or [leaf 1][page 31 - n][number n], where n is log2(page bytes / 256).
/// Links of nodes have slots, or numbers if the trees have too many pages for slots. Lists of the
/// mask and attribute pages have numbers.
class LinkFormat {
 public:
  constexpr LinkFormat(std::uint32_t page_bytes, LinkTarget target)
      : record_bits_(static_cast<unsigned>(std::countr_zero(page_bytes)) -
                     (target == LinkTarget::kSlot ? kSlotShift : kNumberShift)),
        target_(target) {}
  /// The format of links with numbers.
  static constexpr LinkFormat numbered(std::uint32_t page_bytes) {
    return {page_bytes, LinkTarget::kNumber};
  }
  /// The format for a file whose trees have so many pages: slots if they suffice.
  static constexpr LinkFormat of_pages(std::uint32_t page_bytes, std::uint32_t pages) {
    const LinkFormat slots(page_bytes, LinkTarget::kSlot);
    return pages <= slots.max_pages() ? slots : numbered(page_bytes);
  }

  static constexpr std::uint32_t kLeafBit = std::uint32_t{1} << 31;
  static constexpr bool is_leaf(std::uint32_t link) { return (link & kLeafBit) != 0; }
  constexpr LinkTarget target() const { return target_; }
  constexpr std::uint32_t page(std::uint32_t link) const {
    return (link & ~kLeafBit) >> record_bits_;
  }
  /// Returns the slot or the number, as target() says.
  constexpr std::uint32_t record(std::uint32_t link) const {
    return link & ((std::uint32_t{1} << record_bits_) - 1);
  }
  /// Returns a link to a slot or a number, as target() says.
  constexpr std::uint32_t make(bool leaf, std::uint32_t page, std::uint32_t record) const {
    return (leaf ? kLeafBit : 0) | page << record_bits_ | record;
  }
  /// Returns the link to a block. Its target is a number.
  constexpr std::uint32_t make_block(StoredLink block) const {
    return make(true, block.page, block.record);
  }
  /// Returns how many pages a link can tell apart. No link has all bits.
  constexpr std::uint32_t max_pages() const {
    return (std::uint32_t{1} << (31 - record_bits_)) - (target_ == LinkTarget::kNumber ? 1 : 0);
  }

 private:
  // The smallest block has 256 bytes, and nodes have more.
  static constexpr unsigned kSlotShift = 6, kNumberShift = 8;
  unsigned record_bits_;
  LinkTarget target_;
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
constexpr std::uint32_t root_link_of(std::uint32_t page_bytes, LinkTarget target,
                                     std::uint32_t first_page, std::uint64_t node_count) {
  const std::uint32_t record = target == LinkTarget::kSlot ? frame_head_slots(page_bytes) : 0;
  return LinkFormat(page_bytes, target).make(node_count == 0, first_page, record);
}

}  // namespace planetree::octree
