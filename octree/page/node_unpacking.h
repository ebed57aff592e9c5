#pragma once

#include <array>
#include <cstdint>

#include "octree/geometry/child_bounds.h"
#include "octree/page/frame.h"

/// The discs of a node's children, unpacked all at once where the processor can. The same bits on
/// every instruction set, and as unpack_disc() has them.
namespace planetree::octree {

/// As stored, of the children of one node side by side, 0 past the last.
struct PackedDiscs {
  using Bytes = std::array<std::uint8_t, kFanOut>;
  struct Words {
    Bytes low{}, high{};
  };

  Words u, v;                    ///< of normals; i16
  Words slab_lower, slab_upper;  ///< i16
  Words radius;                  ///< u16
};

/// What was found of a node's children.
struct ChildFaults {
  bool no_box = false;   ///< one's box has its upper side below the lower
  bool crossed = false;  ///< one's planes have
};

/// Writes the discs of `node`, which has its box, the step, and what is counted in it of the
/// children's boxes.
ChildFaults unpack_discs(const PackedDiscs& packed, unsigned count, Node& node) noexcept;

}  // namespace planetree::octree
