#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/page/byte_split.h"

/// The raw bytes of a mask page, specified in format-spec/v1/spec.md, "Mask page": a head, then
/// these streams without padding:
///
///     record kinds     u8 a record (MaskKind)
///     grey masks       u8 a node
///     leaf masks       u8 a node
///     black masks      u8 a node
///     inverted masks   u8 a node
///     linked pages     u32 a node of kind kNodeWithLink: page within the mask
///     linked records   u16 a node of kind kNodeWithLink: number in that page
///     corner bits      u8 a record of kind kPlainCorners
///     corners          i8 x 8 a record of kind kCorners
///     plane counts     u8 a special cell
///     behind           i8 a special cell
///     beyond           i8 a special cell
///     planes           float32 or float64 x 9 a plane
///     least            i8 a listed cell
///     higher           u8 a listed cell
///     block counts     u8 a listed cell
///     slab directions  u16 a listed cell
///     slab lowers      u8 a listed cell
///     slab uppers      u8 a listed cell
///     block octants    u8 a block of a list
///     block pages      u32 a block of a list
///     block numbers    u16 a block of a list: number in that page
///
/// All streams of more than a byte are byte-stream split, as in octree/page/page_streams.h.
namespace planetree::octree {

enum class MaskKind : std::uint8_t {
  kNode = 0,          ///< a node whose family, if it has one, is the next of this page
  kNodeWithLink = 1,  ///< a node whose family is in another page, given by a link
  kPlainCorners = 2,  ///< a leaf whose winding numbers are 0 or 1
  kCorners = 3,
  kSpecial = 4,
  kListed = 5,
};

struct MaskPageHead {
  std::uint32_t page_number;
  std::uint32_t ordinal;  ///< 0
  std::uint64_t octcode;
  std::uint16_t record_count;
  std::uint16_t root_count;  ///< records at the front: families that other pages link to
  std::uint16_t node_count;  ///< nodes of both kinds
  std::uint16_t page_link_count;
  std::uint16_t plain_count;
  std::uint16_t corners_count;
  std::uint16_t special_count;
  std::uint16_t plane_count;
  std::uint16_t listed_count;
  std::uint16_t block_link_count;  ///< blocks of all lists
  std::uint32_t reserved;          ///< 0
};
static_assert(sizeof(MaskPageHead) == 40);

/// The streams of a mask page. Their lengths have been checked, their contents have not.
struct MaskStreams {
  MaskPageHead head{};
  ByteSplit<std::uint8_t> kinds;
  ByteSplit<std::uint8_t> grey, leaf, black, inverted;
  ByteSplit<std::uint32_t> linked_pages;
  ByteSplit<std::uint16_t> linked_records;
  ByteSplit<std::uint8_t> plain_corners;
  ByteSplit<std::int8_t> corners;
  ByteSplit<std::uint8_t> plane_counts;
  ByteSplit<std::int8_t> behind, beyond;
  ByteSplit<float> planes32;
  ByteSplit<double> planes64;
  ByteSplit<std::int8_t> least;
  ByteSplit<std::uint8_t> higher, block_counts;
  ByteSplit<std::uint16_t> slab_directions;
  ByteSplit<std::uint8_t> slab_lowers, slab_uppers, block_octants;
  ByteSplit<std::uint32_t> block_pages;
  ByteSplit<std::uint16_t> block_numbers;

  /// Locates the streams in `raw`, which must outlive this object. Returns null, or a fault.
  const char* read(std::span<const std::byte> raw, bool float64) noexcept;

  double plane_coordinate(std::size_t index) const {
    return planes64.size() > 0 ? planes64[index] : static_cast<double>(planes32[index]);
  }
};

}  // namespace planetree::octree
