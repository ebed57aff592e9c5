#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/page/frame.h"
#include "planetree/error.h"

namespace planetree::octree {

/// What decoding a page must know of its file and of its table entry.
struct PageInfo {
  std::uint32_t page_bytes = 0;  ///< of every frame
  std::uint32_t first_page = 0;  ///< of the page's section
  std::uint32_t page_count = 0;  ///< of the page's section
  BlockShape shape;
  std::uint32_t page_number = 0;
  std::uint64_t octcode = 0;
  std::uint32_t ordinal = 0;
};

/// Unpacks the raw bytes of a page into its frame (octree/page/frame.h).
///
/// raw     any bytes at all: everything in them is checked before it is used.
/// frame   facts.page_bytes bytes, 64-byte aligned; undefined after an error.
/// errors  kDamaged, naming the page and what is wrong with it.
/// After success every link inside the page leads to a record of the right
/// kind further on, links to other pages name a page of greater number, boxes
/// lie within their parents', floats are finite, corner indices are in range.
/// threads any; no allocation, no exception.
/// source  format-spec/v1/spec.md, "Distance page".
Result<void> decode_page(std::span<const std::byte> raw, const PageInfo& info,
                         std::span<std::byte> frame) noexcept;

}  // namespace planetree::octree
