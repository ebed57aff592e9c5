#pragma once

#include <cstdint>

#include "octree/mask_frame.h"

namespace planetree::octree {

/// What a ColourMap has of a grey cell of a mask: a node as the mask has it, where a leaf is, or
/// where its list of blocks is.
struct MapRecord {
  std::uint32_t link = 0;  ///< to a node's family, a leaf's record, or its list
  std::uint8_t grey = 0;   ///< as the rest of a node: MaskNode; 0 in all others
  std::uint8_t leaf = 0;   ///< else: kLeaf, or kListed and more
  std::uint8_t black = 0;
  std::uint8_t inverted = 0;

  static constexpr MapRecord of_node(const MaskNode& node) {
    return {node.family, node.grey, node.leaf, node.black, node.inverted};
  }
  /// levels_above  the leaf is of a cell so many levels above this one, up to 3.
  static constexpr MapRecord of_leaf(std::uint32_t link, unsigned levels_above) {
    return {link, 0, static_cast<std::uint8_t>(kLeaf | levels_above), 0, 0};
  }
  /// A leaf that has() a list at `link`.
  static constexpr MapRecord of_list(const MaskListed& listed, std::uint32_t link,
                                     unsigned levels_above) {
    const unsigned least = listed.least == 0 ? 0 : kLeastIsMinus1;
    return {link, 0, static_cast<std::uint8_t>(kListed | least | levels_above), listed.block_count,
            listed.higher};
  }
  static constexpr bool has(const MaskListed& listed) {
    return listed.least == 0 || listed.least == -1;
  }

  constexpr bool is_node() const { return grey != 0; }
  constexpr bool is_leaf() const { return grey == 0 && (leaf & kLeaf) != 0; }
  constexpr bool is_listed() const { return grey == 0 && (leaf & kListed) != 0; }
  constexpr bool is_nothing() const { return grey == 0 && leaf == 0; }
  constexpr unsigned levels_above() const { return grey != 0 ? 0 : leaf & kLevelsAbove; }
  /// The leaf of a list, which is from `slot` on.
  constexpr MaskListed listed(std::uint32_t slot) const {
    return {kListedTag, black, static_cast<std::int8_t>((leaf & kLeastIsMinus1) != 0 ? -1 : 0),
            inverted, slot};
  }

 private:
  static constexpr unsigned kLeaf = 0x80, kListed = 0x40, kLeastIsMinus1 = 0x20, kLevelsAbove = 3;
};
static_assert(sizeof(MapRecord) == 8);

}  // namespace planetree::octree
