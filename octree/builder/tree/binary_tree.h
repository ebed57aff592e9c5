#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/sort/morton_order.h"
#include "octree/builder/sort/triangles.h"
#include "octree/geometry/child_bounds.h"

namespace planetree::octree {

/// A node over the triangles keys[begin ... end).
struct BinaryNode {
  FloatBox box;  ///< relative to the model's centre, rounded outward
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  std::uint32_t left = 0;  ///< child nodes; 0 in a leaf, since node 0 is the root
  std::uint32_t right = 0;

  bool leaf() const { return left == 0; }
  std::uint32_t count() const { return end - begin; }
};

/// Splits the triangles in two again and again until at most 16 are left: by the bits of their
/// Morton codes down to 512 triangles, from there by least surface area. Reorders `keys` within
/// those groups of up to 512.
///
/// centre  centre of the model; boxes are relative to it.
/// return  the nodes; node 0 is the root, and children come after their parent.
std::vector<BinaryNode> build_binary_tree(const Triangles& mesh, const Point& centre,
                                          std::vector<MortonKey>& keys);

}  // namespace planetree::octree
