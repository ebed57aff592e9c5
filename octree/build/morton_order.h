#pragma once

#include <cstdint>
#include <vector>

#include "octree/build/mesh_store.h"

namespace planetree::octree {

/// A triangle and the finest octree cell of its box centre.
struct MortonKey {
  std::uint64_t code;
  std::uint32_t position;  ///< in the MeshStore
};

/// All triangles, by (code, position). The root cell is the cube of side 2
/// at the box's least corner, so that every coordinate falls inside it.
/// Uses the calling thread's TBB arena; the result depends on the mesh alone.
std::vector<MortonKey> morton_order(const MeshStore& mesh);

}  // namespace planetree::octree
