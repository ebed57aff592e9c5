#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/mask_frame.h"
#include "octree/mask_lookup.h"
#include "octree/tree_view.h"

namespace planetree::octree {

/// Link to record of a mask, by way of its page. Looks a page up only where the page changes.
class MaskRecords {
 public:
  MaskRecords(const MaskFacts& mask, PageReader pages)
      : links_(mask.page_bytes), first_page_(mask.first_page), pages_(pages) {}

  /// The mask's root; null if its page cannot be had.
  const std::byte* root(TreeWork& work) {
    turn_to(0, work);
    return frame_ ? slot(header().first_record_slot) : nullptr;
  }
  bool root_is_node() const { return is_mask_node(frame_, header().first_record_slot); }

  /// Whether a node's children are in the page of the last record.
  bool has_family_at_hand(const MaskNode& node) const { return links_.page(node.family) == page_; }

  /// The record of a grey octant; null if its page cannot be had or does not
  /// hold what the node says.
  const std::byte* child(const MaskNode& node, unsigned octant, TreeWork& work) {
    const unsigned below = (1U << octant) - 1;
    const std::uint32_t page = links_.page(node.family);
    const std::uint32_t at = links_.slot(node.family) + count_octants(node.grey & below);
    // Links within a page were checked when it was decoded.
    if (page != page_) {
      const bool leaf = (node.leaf >> octant & 1) != 0;  // the node goes with its page
      turn_to(page, work);
      if (!frame_ || !holds(at, leaf)) return nullptr;
    }
    return slot(at);
  }

  const std::byte* slot(std::uint32_t number) const { return frame_ + number * kMaskSlotBytes; }

 private:
  static constexpr std::uint32_t kNoPage = ~std::uint32_t{0};

  bool holds(std::uint32_t at, bool leaf) const {
    return at >= header().first_record_slot &&
           at < std::uint32_t{header().first_record_slot} + header().record_count &&
           is_mask_node(frame_, at) != leaf;
  }
  const MaskHeader& header() const { return *reinterpret_cast<const MaskHeader*>(frame_); }
  void turn_to(std::uint32_t page, TreeWork& work) {
    if (page == page_) return;
    ++work.page_turns;
    page_ = page;
    frame_ = pages_.page(pages_.context, first_page_ + page);
  }

  const MaskLinkFormat links_;
  const std::uint32_t first_page_;
  const PageReader pages_;
  std::uint32_t page_ = kNoPage;
  const std::byte* frame_ = nullptr;
};

}  // namespace planetree::octree
