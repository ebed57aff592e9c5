#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "octree/frame.h"

namespace planetree::octree {

/// A child to visit: a squared lower bound on its distance, and its link.
struct FrontierEntry {
  float bound;
  std::uint32_t link;
};

/// The children of one node that are worth a visit, nearest first; one cache line.
/// Squared bounds are not negative, so their bits order as they do.
struct alignas(kSlotBytes) FrontierGroup {
  std::int32_t bound_bits[kFanOut];
  std::uint32_t link[kFanOut];

  FrontierEntry entry(unsigned at) const {
    return {std::bit_cast<float>(bound_bits[at]), link[at]};
  }
};

/// Children still to visit: a group for each node on the way down, the last on top.
/// Depth bounds their number.
class Frontier {
 public:
  bool has_room() const { return size_ < kMaxGroups; }

  /// Where the next group is to be written; push() then counts it in.
  FrontierGroup& next() { return groups_[size_]; }
  /// The group has `count` entries.
  void push(unsigned count) {
    if (count != 0) cursors_[size_++] = {0, static_cast<std::uint8_t>(count)};
  }

  /// Takes the nearest child of the last group. Groups with none within
  /// `threshold` are dropped; `dropped` becomes the least bound of such, if
  /// less. False when nothing is left.
  bool pop(float threshold, FrontierEntry& entry, float& dropped) {
    while (size_ > 0) {
      Cursor& cursor = cursors_[size_ - 1];
      entry = groups_[size_ - 1].entry(cursor.next);
      if (entry.bound <= threshold) {
        if (++cursor.next == cursor.end) --size_;
        return true;
      }
      dropped = std::min(dropped, entry.bound);
      --size_;
    }
    return false;
  }

 private:
  struct Cursor {
    std::uint8_t next, end;  // of the group's entries
  };
  static constexpr std::size_t kMaxGroups = kMaxHeight + 1;
  std::size_t size_ = 0;
  Cursor cursors_[kMaxGroups];
  FrontierGroup groups_[kMaxGroups];
};

}  // namespace planetree::octree
