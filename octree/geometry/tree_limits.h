#pragma once

/// Limits of every tree, given by the format, and of what is computed of it. The former also set
/// the width of vectors of children and of triangles. Lengths are in the model frame.
namespace planetree::octree {

inline constexpr unsigned kFanOut = 8;  ///< children of a node
inline constexpr unsigned kMaxBlockTriangles = 16;
inline constexpr unsigned kMaxBlockVertices = 48;
inline constexpr unsigned kMaxHeight = 96;  ///< nodes on a path from the root to a block

/// Maximum magnitude of a coordinate in a page. Within it, no square and no product of squares
/// overflows in double. Coordinates that the builder writes are below 2^55.
inline constexpr double kMaxCoordinate = 0x1p60;
/// Maximum coordinate, relative to the model's centre, of a query that bounds in float can tell
/// anything of: 3 (2^60 + 2^2)^2 is below 2^127.
inline constexpr double kMaxFloatQuery = 0x1p60;
/// Squares from this on count as infinity in float, which ends at 2^128.
inline constexpr double kMaxFloatSquare = 0x1p127;
/// Minimum extent of a block that is filtered in float. In a smaller one, products of squares
/// underflow.
inline constexpr float kFilterMinExtent = 0x1p-40f;
/// Farther queries need no traversal: subtracting coordinates up to kMaxCoordinate from such a
/// query changes no bit of any squared distance. The nearest triangle is then the one of least
/// index.
inline constexpr double kMaxQueryCoordinate = 0x1p300;

}  // namespace planetree::octree
