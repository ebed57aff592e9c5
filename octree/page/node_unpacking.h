#pragma once

#include <array>
#include <cstdint>

#include "octree/geometry/child_bounds.h"
#include "octree/page/frame.h"

/// Unpacks the discs of all children of a node at once, with vectors where the processor has them.
/// All instruction sets compute the same bits as unpack_disc().
namespace planetree::octree {

/// The discs of one node's children as stored, side by side; 0 behind the last child.
struct PackedDiscs {
  using Bytes = std::array<std::uint8_t, kFanOut>;
  struct Words {
    Bytes low{}, high{};
  };

  Words u, v;                    ///< normal; i16
  Words slab_lower, slab_upper;  ///< i16
  Words radius;                  ///< u16
};

/// Faults found in a node's children.
struct ChildFaults {
  bool inverted_box = false;   ///< a child's box has an upper side below the lower one
  bool inverted_slab = false;  ///< a child's slab_upper is below its slab_lower
};

/// Writes the discs of the `count` children of `node`. Its box, its step and the steps of the
/// children's boxes (`lower`, `upper`) must be set.
ChildFaults unpack_discs(const PackedDiscs& packed, unsigned count, Node& node) noexcept;

}  // namespace planetree::octree
