#pragma once

/// Limits of every tree, given by the format, and of what is computed of it. The former also set
/// the width of vectors of children and of triangles. Lengths are in the model frame.
namespace planetree::octree {

inline constexpr unsigned kFanOut = 8;  ///< children of a node
inline constexpr unsigned kMaxBlockTriangles = 16;
inline constexpr unsigned kMaxBlockVertices = 48;
inline constexpr unsigned kMaxHeight = 96;  ///< nodes on a path from the root to a block

/// Maximum magnitude of a coordinate in a page. Within it, no square and no product of squares
/// overflows in double. In the core, coordinates that the builder writes are below 2^55.
inline constexpr double kMaxCoordinate = 0x1p112;
/// Maximum magnitude of a coordinate of a plane of the mask, which is of a triangle at the core.
inline constexpr double kMaxPlaneCoordinate = 0x1p60;
/// Maximum coordinate, relative to the model's centre, of a query that bounds in float can tell
/// anything of: 3 (2^60 + 2^2)^2 is below 2^127. Boxes of strays may be so far from it that the
/// square of their bound is infinite, and counts as kMaxFloatBound.
inline constexpr double kMaxFloatQuery = 0x1p60;
inline constexpr float kMaxFloatBound = 0x1.fffffep+127f;
/// Squares from this on count as infinity in float, which ends at 2^128.
inline constexpr double kMaxFloatSquare = 0x1p127;
/// Minimum extent of a block that is filtered in float. In a smaller one, products of squares
/// underflow.
inline constexpr float kFilterMinExtent = 0x1p-40f;
/// Maximum extent of a block that is filtered in float. A product of a side and the way to a query
/// at most twice as far away is then below 2^127. From a query that is farther, the square of its
/// distance exceeds kMaxFloatSquare. Squares of areas may overflow; such bounds are 0 or NaN, which
/// rejects no triangle.
inline constexpr float kFilterMaxExtent = 0x1p60f;
/// Farther queries need no traversal: subtracting coordinates up to kMaxCoordinate from such a
/// query changes no bit of any squared distance. The nearest triangle is then the one of least
/// index.
inline constexpr double kMaxQueryCoordinate = 0x1p300;

}  // namespace planetree::octree
