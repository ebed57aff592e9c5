#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>

#include "octree/page/frame.h"

namespace planetree::octree {

/// Where the blocks of a decoded page are in its frame. Slots ascend with the blocks' numbers.
class BlockTable {
 public:
  /// frame  of decode_page().
  explicit BlockTable(const std::byte* frame) : frame_(frame) {}

  /// Returns the slot of a block; 0 if the page has no such block.
  ///
  /// number  of the block in its page, below max_page_blocks()
  std::uint32_t slot(std::uint32_t number) const {
    std::uint16_t slot;
    std::memcpy(&slot, frame_ + kSlotBytes + number * sizeof slot, sizeof slot);
    return slot;
  }

  /// Prefetches what slot() reads. No answer depends on it.
  void prefetch(std::uint32_t number) const {
    __builtin_prefetch(frame_ + kSlotBytes + number * sizeof(std::uint16_t));
  }

  /// Returns the number of the block that begins in a slot; none if no block does.
  std::optional<std::uint16_t> number_at(std::uint32_t at) const {
    std::uint16_t first = 0;
    std::uint16_t last = reinterpret_cast<const FrameHeader*>(frame_)->block_count;
    while (first < last) {
      const auto middle = static_cast<std::uint16_t>((first + last) / 2);
      if (slot(middle) == at) return middle;
      if (slot(middle) < at)
        first = static_cast<std::uint16_t>(middle + 1);
      else
        last = middle;
    }
    return std::nullopt;
  }

 private:
  const std::byte* frame_;
};

}  // namespace planetree::octree
