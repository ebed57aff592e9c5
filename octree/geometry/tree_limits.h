#pragma once

/// The limits of every tree: what the format allows, and how wide vectors of children and of
/// triangles are.
namespace planetree::octree {

inline constexpr unsigned kFanOut = 8;  ///< children of a node
inline constexpr unsigned kMaxBlockTriangles = 16;
inline constexpr unsigned kMaxBlockVertices = 48;
inline constexpr unsigned kMaxHeight = 96;  ///< nodes between the root and a block

}  // namespace planetree::octree
