#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "octree/page/frame.h"
#include "octree/traversal/bounds.h"

namespace planetree::octree {

/// The subtrees that reach into a ball; the smallest is a block. Queries within the ball start with
/// these instead of the root. Boxes are as decoded from the parent nodes, stored side by side.
class NearbySubtrees {
 public:
  static constexpr std::size_t kMax = 64;

  /// Removes all subtrees.
  void clear() { size_ = 0; }

  /// Returns whether the children of any node fit.
  bool has_capacity() const { return size_ + kFanOut <= kMax; }
  /// Memory for more subtrees while has_capacity(). A vector of kFanOut numbers may be written to
  /// each; add() then adds the first `count` of them.
  float* next_lower(std::size_t axis) { return lower_[axis] + size_; }
  float* next_upper(std::size_t axis) { return upper_[axis] + size_; }
  std::uint32_t* next_link() { return link_ + size_; }
  void add(std::size_t count) { size_ += count; }
  /// Removes a subtree. The last one takes its index.
  void remove(std::size_t at) {
    --size_;
    for (unsigned axis = 0; axis < 3; ++axis) {
      lower_[axis][at] = lower_[axis][size_];
      upper_[axis][at] = upper_[axis][size_];
    }
    link_[at] = link_[size_];
  }

  std::size_t size() const { return size_; }
  bool are_blocks() const { return std::all_of(link_, link_ + size_, LinkFormat::is_leaf); }
  std::uint32_t link(std::size_t i) const { return link_[i]; }
  /// Returns an upper bound on the distance from a query to the surface points of a subtree; see
  /// farthest_in_box().
  double farthest(std::size_t i, const Point& query) const {
    return farthest_in_box(
        {{lower_[0][i], lower_[1][i], lower_[2][i]}, {upper_[0][i], upper_[1][i], upper_[2][i]}},
        query);
  }
  /// Returns a side of each box. Up to the next multiple of sixteen, unspecified numbers follow.
  const float* lower(std::size_t axis) const { return lower_[axis]; }
  const float* upper(std::size_t axis) const { return upper_[axis]; }

 private:
  static constexpr std::size_t kLanes = kMaxBlockTriangles;  // maximum number of lanes in a kernel
  static_assert(kMax % kLanes == 0);

  std::size_t size_ = 0;
  alignas(kSlotBytes) float lower_[3][kMax] = {};
  alignas(kSlotBytes) float upper_[3][kMax] = {};
  std::uint32_t link_[kMax] = {};
};

}  // namespace planetree::octree
