#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "octree/page/frame.h"

namespace planetree::octree {

/// A child to visit: the squared lower bound on its distance, its link, and the page of its parent.
struct FrontierEntry {
  float bound;
  std::uint32_t link;
  std::uint32_t from;
};

/// The children of one node that are to be visited, nearest first; one cache line. Squared bounds
/// are not negative, so that their bits are ordered as they are.
struct alignas(kSlotBytes) FrontierGroup {
  std::int32_t bound_bits[kFanOut];
  std::uint32_t link[kFanOut];

  float bound(unsigned at) const { return std::bit_cast<float>(bound_bits[at]); }
};

/// Children still to visit, in one group for each visited node that has some. Taking the nearest
/// child first keeps the number of visits low. Taking from the last group visits children that lie
/// close together.
class Frontier {
 public:
  enum class Order { kNearest, kLast };
  /// With more groups than this, pop() takes from the last one only, so that the tree's height
  /// bounds how many are added. Few queries have so many groups at once.
  static constexpr std::size_t kMaxToOrder = 48;

  bool has_capacity() const { return size_ < kMaxGroups; }
  /// Returns whether pop() with Order::kNearest takes the nearest of all children.
  bool is_ordered() const { return size_ <= kMaxToOrder; }

  /// Returns the memory of the next group. push() adds that group.
  FrontierGroup& next() { return groups_[size_]; }
  /// Adds the next group with its entries from `first` to before `end`. `from` is the page of their
  /// parent.
  void push(unsigned first, unsigned end, std::uint32_t from) {
    if (first >= end) return;
    cursors_[size_] = {from, static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(end)};
    set_key(size_, groups_[size_].bound_bits[first]);
    ++size_;
  }

  /// Takes a child whose bound is not above `threshold` out of the frontier. Children above it are
  /// dropped, and `dropped` is lowered to their least bound. Returns false if no child is left.
  bool pop(Order order, float threshold, FrontierEntry& entry, float& dropped) {
    // A local copy stays in a register. In memory, each update would wait for the one before.
    float min_dropped = dropped;
    const bool found = pop_near(order, threshold, entry, min_dropped);
    dropped = min_dropped;
    return found;
  }

 private:
  bool pop_near(Order order, float threshold, FrontierEntry& entry, float& dropped) {
    while (size_ > 0) {
      const bool nearest = order == Order::kNearest && is_ordered();
      const std::size_t at = nearest ? nearest_group() : size_ - 1;
      Cursor& cursor = cursors_[at];
      const FrontierGroup& group = groups_[at];
      entry = {group.bound(cursor.next), group.link[cursor.next], cursor.from};
      if (entry.bound <= threshold) {
        if (++cursor.next == cursor.end)
          remove(at);
        else
          set_key(at, group.bound_bits[cursor.next]);
        return true;
      }
      dropped = std::min(dropped, entry.bound);
      size_ = nearest ? 0 : size_ - 1;
    }
    return false;
  }

  struct Cursor {
    std::uint32_t from;
    std::uint8_t next, end;  // range of the group's entries still to visit
  };
  // While groups are ordered, a traversal takes two children at a time; the path down from each
  // adds one group a level.
  static constexpr std::size_t kMaxGroups = kMaxToOrder + std::size_t{2} * (kMaxHeight + 1);

  // Sets a group's key: its least bound and its index, reversed so that the last of equal groups
  // comes first.
  void set_key(std::size_t at, std::int32_t bound_bits) {
    keys_[at] = std::uint64_t{static_cast<std::uint32_t>(bound_bits)} << 32 | (kMaxGroups - at);
  }
  std::size_t nearest_group() const {
    std::uint64_t least = keys_[0];
    for (std::size_t i = 1; i < size_; ++i) least = std::min(least, keys_[i]);
    return kMaxGroups - static_cast<std::uint32_t>(least);
  }
  void remove(std::size_t at) {
    if (at == --size_) return;
    groups_[at] = groups_[size_];
    cursors_[at] = cursors_[size_];
    set_key(at, groups_[at].bound_bits[cursors_[at].next]);
  }

  std::size_t size_ = 0;
  std::uint64_t keys_[kMaxGroups];
  Cursor cursors_[kMaxGroups];
  FrontierGroup groups_[kMaxGroups];
};

}  // namespace planetree::octree
