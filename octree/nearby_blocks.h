#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "octree/frame.h"

namespace planetree::octree {

/// All blocks that reach into a ball, where they are few: queries within it look at no node at
/// all. Boxes as in the nodes that have them, side by side.
class NearbyBlocks {
 public:
  static constexpr std::size_t kMost = 96;

  /// Forgets what was there.
  void begin() {
    size_ = 0;
    complete_ = false;
  }

  /// A child of a node that is a block. False where there is no room for it.
  bool add(const Node& node, unsigned child) {
    if (size_ == kMost) return false;
    for (unsigned axis = 0; axis < 3; ++axis) {
      lower_[axis][size_] = node.lower[axis][child];
      upper_[axis][size_] = node.upper[axis][child];
    }
    link_[size_++] = node.link[child];
    return true;
  }

  /// All have been added.
  void finish() {
    complete_ = size_ > 0;
    for (std::size_t i = size_; i % kFanOut != 0; ++i)
      for (unsigned axis = 0; axis < 3; ++axis)
        lower_[axis][i] = upper_[axis][i] = std::numeric_limits<float>::infinity();
  }

  /// Whether there is a list, and of all.
  bool complete() const { return complete_; }
  std::size_t size() const { return size_; }
  std::uint32_t link(std::size_t i) const { return link_[i]; }
  /// A side of each box; up to the next multiple of eight, of boxes infinitely far away.
  const float* lower(std::size_t axis) const { return lower_[axis]; }
  const float* upper(std::size_t axis) const { return upper_[axis]; }

 private:
  std::size_t size_ = 0;
  bool complete_ = false;
  alignas(kSlotBytes) float lower_[3][kMost];
  alignas(kSlotBytes) float upper_[3][kMost];
  std::uint32_t link_[kMost];
};

}  // namespace planetree::octree
