#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/page/frame.h"
#include "planetree/error.h"

namespace planetree::octree {

/// What decoding a page needs from its file's header and from its entry in the directory.
struct PageInfo {
  std::uint32_t page_bytes = 0;  ///< bytes of every frame
  std::uint32_t first_page = 0;  ///< first page of the page's section
  std::uint32_t page_count = 0;  ///< pages of the page's section
  /// Pages of trees: of a mask page those that its lists link to, of an attribute page those of the
  /// surface.
  std::uint32_t tree_pages = 0;
  BlockShape shape;
  std::uint32_t page_number = 0;
  std::uint64_t octcode = 0;
};

/// Compares the number and the octcode in the head of a page, of any kind, with those of its entry
/// in the directory. Returns null, or a fault.
template <class Head>
const char* fault_of_key(const Head& head, const PageInfo& info) noexcept {
  if (head.page_number != info.page_number) return "it is another page's bytes";
  if (head.octcode != info.octcode) return "its octcode is not the directory's";
  return nullptr;
}

/// Unpacks the raw bytes of a distance page into its frame (octree/page/frame.h).
///
/// raw      arbitrary bytes; everything in them is checked before it is used
/// frame    info.page_bytes bytes, 64-byte aligned; undefined after an error
/// return   on success, every link within the page leads to a later record of the right kind, links
///          to other pages name a page of greater number, boxes lie within their parents', floats
///          are finite, and corner indices are in range
/// errors   kDamaged, naming the page and the fault
/// threads  any; no allocation, no exception
/// source   format-spec/v1/spec.md, "Distance page"
Result<void> decode_page(std::span<const std::byte> raw, const PageInfo& info,
                         std::span<std::byte> frame) noexcept;

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
