#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/sort/triangles.h"

namespace planetree::octree {

/// A triangle and the finest octree cell of its box centre.
struct MortonKey {
  std::uint64_t code;
  std::uint32_t position;  ///< in its Triangles
};

/// The code of a triangle's finest cell. The root cell is the cube of side 2 at the model's
/// least corner, so that every coordinate falls inside it.
std::uint64_t morton_code_of(const Triangle& triangle, const Point& lower);

/// The keys of triangles that are in order.
std::vector<MortonKey> keys_of(const Triangles& sorted);

}  // namespace planetree::octree
