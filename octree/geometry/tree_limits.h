#pragma once

/// Limits of every tree, given by the format. They also set the width of vectors of children and of
/// triangles.
namespace planetree::octree {

inline constexpr unsigned kFanOut = 8;  ///< children of a node
inline constexpr unsigned kMaxBlockTriangles = 16;
inline constexpr unsigned kMaxBlockVertices = 48;
inline constexpr unsigned kMaxHeight = 96;  ///< nodes on a path from the root to a block

}  // namespace planetree::octree
