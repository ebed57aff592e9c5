#pragma once

#include <cstdint>
#include <span>

#include "octree/build/morton_order.h"
#include "octree/child_bounds.h"

namespace planetree::octree {

inline constexpr std::uint32_t kMaxAreaSplit = 512;

/// A triangle about to be split off: its key and its box.
struct SplitItem {
  MortonKey key;
  FloatBox box;
};

/// Reorders `items`, more than a block's and up to kMaxAreaSplit, so that the first `return`
/// of them make the left part of the cheapest split: least surface area times triangle
/// blocks, over all places in the orders of the three centre coordinates. Ties go to the
/// first axis and the place next to the middle, equal coordinates to the lesser position.
std::uint32_t split_by_area(std::span<SplitItem> items);

}  // namespace planetree::octree
