#pragma once

#include <array>
#include <cstdint>

#include "octree/child_bounds.h"
#include "octree/frame.h"

/// A node's children as stored, unpacked all at once where the processor can. The same bits on
/// every instruction set, and as unpack_box() and unpack_disc() have them.
namespace planetree::octree {

/// Of the children of one node side by side, 0 past the last.
struct PackedChildren {
  using Bytes = std::array<std::uint8_t, kFanOut>;
  struct Words {
    Bytes low{}, high{};
  };

  std::array<Bytes, 6> box{};    ///< lower x y z, upper x y z
  Words u, v;                    ///< of normals; i16
  Words slab_lower, slab_upper;  ///< i16
  Words radius;                  ///< u16
};

/// What was found of a node's children.
struct ChildFaults {
  bool no_box = false;   ///< one's box has its upper side below the lower
  bool crossed = false;  ///< one's planes have
};

/// Writes the boxes and discs of `node`. Those of absent children are at infinity, so that no
/// query ever comes near them.
///
/// box  of the node; its diagonal is finite.
ChildFaults unpack_children(const PackedChildren& packed, unsigned count, const FloatBox& box,
                            Node& node) noexcept;

}  // namespace planetree::octree
