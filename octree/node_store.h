#pragma once

#include <cstddef>
#include <cstring>

#include "octree/child_bounds.h"
#include "octree/frame.h"

/// Nodes of the serving layout on their way there.
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

/// What stands between boxes and discs: no links yet.
inline void clear_links(Node& node) {
  constexpr std::size_t kFirst = offsetof(Node, link), kBehind = offsetof(Node, normal);
  std::memset(reinterpret_cast<std::byte*>(&node) + kFirst, 0, kBehind - kFirst);
}

inline FloatBox child_box(const Node& node, std::size_t child) {
  FloatBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lower[axis] = node.lower[axis][child];
    box.upper[axis] = node.upper[axis][child];
  }
  return box;
}

}  // namespace planetree::octree
