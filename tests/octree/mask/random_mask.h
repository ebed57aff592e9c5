#pragma once

#include <cstdint>

#include "octree/builder/mask/mask_tree.h"

namespace planetree::octree {

/// The first page of a mask that lists what random_mask() lists, or any page behind it.
inline constexpr std::uint32_t kRandomMaskPage = 3;

/// A mask of no model: entries of all kinds by chance, as build_mask() lays them out. Blocks are
/// listed by chance too, of pages that come before kRandomMaskPage whatever a page's size.
///
/// levels  of the finest grey cell.
MaskTree random_mask(unsigned levels, std::uint64_t seed = 1);

}  // namespace planetree::octree
