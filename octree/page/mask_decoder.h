#pragma once

#include <cstddef>
#include <span>

#include "octree/page/page_decoder.h"

namespace planetree::octree {

/// Unpacks the raw bytes of a mask page into its frame (octree/page/mask_frame.h).
///
/// raw      arbitrary bytes; everything in them is checked before it is used
/// frame    info.page_bytes bytes, 64-byte aligned; undefined after an error
/// return   on success, every link within the page leads to a later family of the right kinds,
///          links to other pages name a mask page of greater number, no octant has two colours, and
///          planes are finite
/// errors   kDamaged, naming the page and the fault
/// threads  any; no allocation, no exception
/// source   format-spec/v1/spec.md, "Mask page"
Result<void> decode_mask_page(std::span<const std::byte> raw, const PageInfo& info,
                              std::span<std::byte> frame) noexcept;

}  // namespace planetree::octree
