#pragma once

#include <cstdint>

#include "octree/builder/mask/mask_tree.h"

namespace planetree::octree {

/// The minimum page number of a mask from random_mask(): the blocks it lists are in pages before.
inline constexpr std::uint32_t kRandomMaskPage = 2817;

/// A mask that belongs to no model: random entries of all kinds, laid out as build_mask() does. Its
/// lists name random blocks in pages before kRandomMaskPage, for any page size.
///
/// levels  level of the finest grey cells.
MaskTree random_mask(unsigned levels, std::uint64_t seed = 1);

}  // namespace planetree::octree
