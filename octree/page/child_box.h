#pragma once

#include <cstddef>

#include "octree/geometry/child_bounds.h"
#include "octree/page/frame.h"

namespace planetree::octree {

/// Returns the decoded box of one of a node's children.
inline FloatBox child_box(const Node& node, std::size_t child) {
  return unpack_box(node.box, {node.lower[0][child], node.lower[1][child], node.lower[2][child]},
                    {node.upper[0][child], node.upper[1][child], node.upper[2][child]});
}

}  // namespace planetree::octree
