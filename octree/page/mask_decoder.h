#pragma once

#include <cstddef>
#include <span>

#include "octree/page/page_decoder.h"

namespace planetree::octree {

/// Unpacks the raw bytes of a mask page into its frame (octree/page/mask_frame.h).
///
/// raw     any bytes at all: everything in them is checked before it is used.
/// frame   facts.page_bytes bytes, 64-byte aligned; undefined after an error.
/// errors  kDamaged, naming the page and what is wrong with it.
/// After success every link inside the page leads to a family of the right
/// kinds further on, links to other pages name a mask page of greater number,
/// no octant has two colours, planes are finite.
/// threads any; no allocation, no exception.
/// source  format-spec/v1/spec.md, "Mask page".
Result<void> decode_mask_page(std::span<const std::byte> raw, const PageInfo& info,
                              std::span<std::byte> frame) noexcept;

}  // namespace planetree::octree
