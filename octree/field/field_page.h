#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/field/field_shape.h"
#include "octree/page/page_decoder.h"
#include "planetree/error.h"

/// The raw bytes of a field page, specified in format-spec/v1/spec.md, "Field page": a head, then
/// for each axis the differences of the stored surface points, without padding:
///
///     x differences    u16 a point, byte-stream split
///     y differences    likewise
///     z differences    likewise
///
/// The points of all pages together are those of the grid, in its order. A difference is that to
/// the point before in the page, or to 0, modulo 2^16; its sign is moved to the lowest bit.
namespace planetree::octree {

struct FieldPageHead {
  std::uint32_t page_number;
  std::uint32_t ordinal;      ///< number of the page among the field pages
  std::uint64_t octcode;      ///< 0: the root's
  std::uint32_t point_count;  ///< of the page
  std::uint32_t reserved;     ///< 0
};
static_assert(sizeof(FieldPageHead) == 24);

/// Returns the number of points in a field page; the last may have fewer.
constexpr std::uint32_t points_per_field_page(std::uint32_t page_bytes) { return page_bytes / 8; }
/// Returns the number of field pages for so many points.
constexpr std::uint32_t field_pages(std::uint64_t points, std::uint32_t page_bytes) {
  const std::uint32_t in_page = points_per_field_page(page_bytes);
  return static_cast<std::uint32_t>((points + in_page - 1) / in_page);
}

/// Moves the sign of a difference modulo 2^16 to the lowest bit, so that small ones of either sign
/// have a high byte of 0.
constexpr std::uint16_t fold_difference(std::uint16_t difference) {
  const auto sign = static_cast<std::uint16_t>(difference >> 15 ? 0xffff : 0);
  return static_cast<std::uint16_t>((difference << 1) ^ sign);
}
/// Reverses fold_difference().
constexpr std::uint16_t unfold_difference(std::uint16_t folded) {
  const auto sign = static_cast<std::uint16_t>((folded & 1) != 0 ? 0xffff : 0);
  return static_cast<std::uint16_t>((folded >> 1) ^ sign);
}

/// Unpacks the raw bytes of a field page.
///
/// raw      arbitrary bytes; everything in them is checked before it is used
/// points   receives the points of the page; exactly as many as the page must have
/// errors   kDamaged, naming the page and the fault
/// threads  any; no allocation, no exception
Result<void> decode_field_page(std::span<const std::byte> raw, const PageInfo& info,
                               std::span<FieldPoint> points) noexcept;

}  // namespace planetree::octree
