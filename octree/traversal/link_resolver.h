#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/page/block_table.h"
#include "octree/page/frame.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// Finds the record that a link leads to. Looks a page up only when it differs from the last one.
class LinkResolver {
 public:
  /// tree, pages  must outlive this.
  LinkResolver(const TreeInfo& tree, const PageReader& pages)
      : links_(tree.page_bytes, tree.shape.links),
        node_slots_(tree.shape.node_slots()),
        tree_(tree),
        pages_(pages),
        slot_frames_(tree.shape.links == LinkTarget::kSlot ? pages.frames : kNoFrames) {}

  /// A number that no page has.
  static constexpr std::uint32_t kNoPage = ~std::uint32_t{0};

  /// Returns the node or block that `link` leads to, valid until the next call; null if its page is
  /// not available or has no such record.
  ///
  /// from  page of the node with the link, as page() returned it; kNoPage if not known
  const std::byte* find(std::uint32_t link, TraversalStats& work, std::uint32_t from = kNoPage) {
    const std::uint32_t page = links_.page(link);
    const std::uint32_t slot = links_.record(link);
    if (page != page_number_ || !slots_) {
      switch_to(page, work);
      if (!slots_) return frame_ ? record_at(link) : nullptr;
    }
    // Links within a page were checked when it was decoded. Links between pages can be checked only
    // when both pages are decoded.
    if (page != from && !leads_to_record(link, slot)) return nullptr;
    return slots_ + slot * kSlotBytes;
  }
  /// Returns the block that a numbered link leads to, as find() does. Any link is allowed.
  const std::byte* find_numbered(std::uint32_t link, TraversalStats& work) {
    if (!LinkFormat::is_leaf(link)) return nullptr;
    const LinkFormat numbered = LinkFormat::numbered(tree_.page_bytes);
    switch_to(numbered.page(link), work);
    return frame_ ? block(numbered.record(link)) : nullptr;
  }
  /// Returns the page that a link leads to.
  std::uint32_t page_of(std::uint32_t link) const { return links_.page(link); }
  /// Returns whether the record is in the page that was found last.
  bool is_in_current_page(std::uint32_t link) const {
    return links_.page(link) == page_number_ && frame_;
  }
  /// Returns whether the page of the last link is available.
  bool has_page() const { return frame_ != nullptr; }
  /// Notes that the search goes on without the record found last, of this squared bound. Returns
  /// the bound.
  float skip(float bound) const {
    pages_.skip(bound);
    return bound;
  }
  /// Returns the page of the last record.
  std::uint32_t page() const { return page_number_; }

  /// A child, given by its node and its index there.
  struct Child {
    const Node* node = nullptr;
    unsigned index = 0;
  };
  /// Searches the nodes of a page for the child with `link`. Returns no node if the page is not
  /// resident or has no such child.
  Child find_parent(std::uint32_t link, std::uint32_t page) const {
    const std::byte* frame =
        pages_.peek && page != kNoPage ? pages_.peek(pages_.context, page) : nullptr;
    if (!frame) return {};
    const auto& header = *reinterpret_cast<const FrameHeader*>(frame);
    for (unsigned i = 0; i < header.node_count; ++i) {
      const unsigned slot = header.first_node_slot + i * node_slots_;
      const auto* node = reinterpret_cast<const Node*>(frame + slot * kSlotBytes);
      for (unsigned index = 0; index < node->child_count; ++index)
        if (node->link[index] == link) return {node, index};
    }
    return {};
  }

  /// Prefetches the first cache lines of a record if its page is resident and the link leads to a
  /// slot: the place of a number is known only from its page, and one more branch here costs 1 % of
  /// a query's instructions. No answer depends on it. No branch depends on the link, because it
  /// would be mispredicted.
  ///
  /// kNodeLines  lines of a node to prefetch; by default those that queries nearby read
  template <std::size_t kNodeLines = kNearNodeSlots>
  [[gnu::always_inline]] void prefetch(std::uint32_t link) const {
    if (!slot_frames_.cells) return;
    const std::byte* frame = slot_frames_.frame_of(links_.page(link));
    const std::size_t leaf = link >> 31;
    const std::byte* record = frame + links_.record(link) * kSlotBytes;
#pragma GCC unroll 8
    for (std::size_t i = 0; i < kNodeLines; ++i) __builtin_prefetch(record + i * kSlotBytes);
    // For a node, the remaining prefetches repeat its last line.
    const std::byte* last = record + (kNodeLines - 1) * kSlotBytes;
#pragma GCC unroll 8
    for (std::size_t i = kNodeLines; i < kBlockLines; ++i)
      __builtin_prefetch(last += leaf * kSlotBytes);
  }

  /// Prefetches the blocks that numbered links lead to, if their pages are resident. The links are
  /// those of a mask, whose pages exist. No answer depends on it.
  void prefetch_numbered(std::span<const std::uint32_t> links) const {
    if (!pages_.frames.cells || !pages_.peek) return;
    const LinkFormat numbered = LinkFormat::numbered(tree_.page_bytes);
    for (const std::uint32_t link : links)
      BlockTable(pages_.frames.frame_of(numbered.page(link))).prefetch(numbered.record(link));
    std::uint32_t page = kNoPage;
    const std::byte* frame = nullptr;
    for (const std::uint32_t link : links) {
      if (numbered.page(link) != page) {
        page = numbered.page(link);
        frame = pages_.peek(pages_.context, page);
      }
      if (frame) prefetch_block(frame, numbered.record(link));
    }
  }

 private:
  static constexpr std::size_t kBlockLines = 4;  // covers all of most blocks
  static constexpr FrameTable kNoFrames{};

  const FrameHeader& header() const { return *reinterpret_cast<const FrameHeader*>(frame_); }
  void switch_to(std::uint32_t page, TraversalStats& work) {
    if (page == page_number_ && frame_) return;
    ++work.page_switches;
    page_number_ = page;
    frame_ = pages_.page(pages_.context, page);
    slots_ = links_.target() == LinkTarget::kSlot ? frame_ : nullptr;
  }
  // Returns what a link to a number leads to in the current page; null if the page has no such
  // record.
  [[gnu::noinline]] const std::byte* record_at(std::uint32_t link) const {
    const std::uint32_t number = links_.record(link);
    if (!LinkFormat::is_leaf(link)) return node(number);
    // The header of a forged file may state that a tree is one block.
    const bool is_in_tree = !LinkFormat::is_leaf(tree_.root_link) || header().node_count == 0;
    return is_in_tree ? block(number) : nullptr;
  }
  // Returns a node of the current page by its number; null if it has no such node.
  const std::byte* node(std::uint32_t number) const {
    const std::size_t slot = header().first_node_slot + number * node_slots_;
    return number < header().node_count ? frame_ + slot * kSlotBytes : nullptr;
  }
  // Returns a block of the current page by its number; null if it has no such block.
  const std::byte* block(std::uint32_t number) const {
    const std::uint32_t slot = BlockTable(frame_).slot(number);
    return slot == 0 ? nullptr : frame_ + slot * kSlotBytes;
  }
  static void prefetch_block(const std::byte* frame, std::uint32_t number) {
    const std::byte* block = frame + BlockTable(frame).slot(number) * kSlotBytes;
#pragma GCC unroll 4
    for (std::size_t i = 0; i < kBlockLines; ++i) __builtin_prefetch(block + i * kSlotBytes);
  }
  bool leads_to_record(std::uint32_t link, std::uint32_t slot) const {
    // Only the root of a tree may be a block. Links that a page had to its own blocks are right.
    if (LinkFormat::is_leaf(link)) return slot >= header().first_block_slot;
    if (slot < header().first_node_slot) return false;
    const std::uint32_t offset = slot - header().first_node_slot;
    // Constant divisors: a division by node_slots_ would take as long as the node's bounds.
    const bool aligned = node_slots_ == kNodeSlots ? offset % kNodeSlots == 0
                                                   : offset % (kNodeSlots + kMomentSlots) == 0;
    return aligned && offset < header().node_count * node_slots_;
  }

  const LinkFormat links_;
  const unsigned node_slots_;
  const TreeInfo& tree_;
  const PageReader& pages_;
  const FrameTable& slot_frames_;  // of the reader; empty if links lead to numbers
  std::uint32_t page_number_ = kNoPage;
  const std::byte* frame_ = nullptr;  // of the current page
  const std::byte* slots_ = nullptr;  // the same; null if links lead to numbers
};

}  // namespace planetree::octree
