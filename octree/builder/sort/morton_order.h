#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/sort/triangles.h"

namespace planetree::octree {

/// Morton code and position of a triangle. The code is that of the finest octree cell that holds
/// the centre of the triangle's box.
struct MortonKey {
  std::uint64_t code;
  std::uint32_t position;  ///< in the Triangles it belongs to
};

/// Morton code of the finest cell with the centre of a triangle's box. The root cell is the cube of
/// side 2 at the least corner of the model's box, so that it holds every such centre.
/// lower  least corner of the model's box.
std::uint64_t morton_code_of(const Triangle& triangle, const Point& lower);

/// The keys of triangles that are sorted.
std::vector<MortonKey> keys_of(const Triangles& sorted);

}  // namespace planetree::octree
