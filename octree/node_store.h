#pragma once

#include <cstring>
#include <limits>

#include "octree/child_bounds.h"
#include "octree/frame.h"

/// Writing nodes in the serving layout, child by child.
namespace planetree::octree {

/// Leaves a node's own box in its place until the node itself is written:
/// parents come before their children, and the box is known from the parent.
inline void stage_box(Node& node, const FloatBox& box) {
  std::memcpy(static_cast<void*>(&node), &box, sizeof box);
}

inline FloatBox staged_box(const Node& node) {
  FloatBox box;
  std::memcpy(static_cast<void*>(&box), &node, sizeof box);
  return box;
}

/// Every child absent: at infinity, so that no query ever comes near it.
inline void clear_node(Node& node) {
  std::memset(static_cast<void*>(&node), 0, sizeof node);
  for (unsigned child = 0; child < kFanOut; ++child) {
    for (int axis = 0; axis < 3; ++axis) {
      node.lower[axis][child] = std::numeric_limits<float>::infinity();
      node.upper[axis][child] = std::numeric_limits<float>::infinity();
    }
    node.normal[2][child] = 1;
  }
}

inline void store_child(Node& node, std::size_t child, const FloatBox& box, const Disc& disc) {
  for (int axis = 0; axis < 3; ++axis) {
    node.lower[axis][child] = box.lower[axis];
    node.upper[axis][child] = box.upper[axis];
    node.normal[axis][child] = disc.normal[axis];
  }
  node.slab_lower[child] = disc.slab_lower;
  node.slab_upper[child] = disc.slab_upper;
  node.radius[child] = disc.radius;
}

}  // namespace planetree::octree
