#pragma once

#include <cstdint>

#include "octree/geometry/cell_slab.h"
#include "octree/page/mask_frame.h"

namespace planetree::octree {

/// What a SideGrid has of a grey cell of a mask: a copy of a node, the link to a leaf, or the link
/// to a leaf's list of blocks and the leaf's slab. A record does not straddle cache lines.
struct alignas(16) SideGridRecord {
  static constexpr int kUnknown = 2;  ///< no sign of a winding number

  std::uint32_t link = 0;                  ///< to a node's family, a leaf's record, or its list
  std::uint32_t slab = CellSlab{}.word();  ///< slab of a listed leaf
  std::uint8_t grey = 0;                   ///< of a node, as in MaskNode; 0 in other records
  std::uint8_t leaf = kNothing;            ///< of a node, as in MaskNode; else a kind and flags
  std::uint8_t black = 0;                  ///< as in MaskNode; of a list: the count of blocks
  std::uint8_t inverted = 0;               ///< as in MaskNode; of a list: MaskListed::higher
  std::uint8_t touched = 0xff;             ///< octants of this cell that listed blocks touch

  static constexpr SideGridRecord of_node(const MaskNode& node) {
    return {.link = node.family,
            .grey = node.grey,
            .leaf = node.grey != 0 ? node.leaf : kOneColour,
            .black = node.black,
            .inverted = node.inverted};
  }
  /// Makes the record of a cell of one colour.
  static constexpr SideGridRecord of_colour(int winding) {
    MaskNode node{};
    (winding < 0 ? node.inverted : node.black) = winding != 0 ? 0xff : 0;
    return of_node(node);
  }
  /// Makes the record of a leaf that is not listed.
  ///
  /// levels_above  levels from this cell up to the leaf's cell, 0 to 7
  static constexpr SideGridRecord of_leaf(std::uint32_t link, unsigned levels_above) {
    return {.link = link, .leaf = static_cast<std::uint8_t>(kLeaf | levels_above)};
  }
  /// Makes the record of a listed leaf for which has() is true. Its list is at `link`.
  ///
  /// touched       octants of the leaf that listed blocks touch; used if levels_above is 0
  /// levels_above  as in of_leaf()
  static constexpr SideGridRecord of_list(const MaskListed& listed, std::uint32_t link,
                                          const CellSlab& slab, unsigned touched,
                                          unsigned levels_above) {
    const unsigned least = listed.least == 0 ? 0 : kMinIsMinus1;
    return {.link = link,
            .slab = slab.word(),
            .leaf = static_cast<std::uint8_t>(kListed | least | levels_above),
            .black = listed.block_count,
            .inverted = listed.higher,
            .touched = static_cast<std::uint8_t>(levels_above == 0 ? touched : 0xff)};
  }
  /// Whether a record can hold the corner numbers of a listed leaf.
  static constexpr bool has(const MaskListed& listed) {
    return listed.least == 0 || listed.least == -1;
  }

  constexpr bool is_node() const { return grey != 0; }
  constexpr bool is_leaf() const { return grey == 0 && (leaf & kLeaf) != 0; }
  constexpr bool is_listed() const { return grey == 0 && (leaf & kListed) != 0; }
  constexpr bool is_nothing() const { return grey == 0 && leaf == kNothing; }
  constexpr unsigned levels_above() const { return grey != 0 ? 0 : leaf & kLevelsAbove; }
  /// The node as the mask has it.
  constexpr MaskNode node() const { return {link, grey, leaf, black, inverted}; }
  /// The listed leaf as the mask has it, with a list that starts at `slot`.
  constexpr MaskListed listed(std::uint32_t slot) const {
    return {kListedTag, black, static_cast<std::int8_t>((leaf & kMinIsMinus1) != 0 ? -1 : 0),
            inverted, slot};
  }
  /// The sign of the winding number in an octant of this cell; kUnknown where it is grey.
  constexpr int winding(unsigned octant) const {
    if (is_listed())
      return (touched >> octant & 1) != 0 ? kUnknown : corner_number(listed(0), octant);
    const bool certain = grey != 0 ? (grey >> octant & 1) == 0 : leaf == kOneColour;
    return certain ? (black >> octant & 1) - (inverted >> octant & 1) : kUnknown;
  }

 private:
  static constexpr std::uint8_t kOneColour = 0, kLeaf = 0x80, kListed = 0x40, kMinIsMinus1 = 0x20,
                                kNothing = 0x10, kLevelsAbove = 7;
};
static_assert(sizeof(SideGridRecord) == 16);

}  // namespace planetree::octree
