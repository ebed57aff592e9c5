#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "planetree/types.h"

/// Distance from a point to a triangle, in double.
///
/// Every answer of the library is decided here: the wide float kernels only
/// say which triangles need not be looked at.
namespace planetree::octree {

using Point = Eigen::Vector3d;
using Triangle = std::array<Point, 3>;

/// What triangles are compared by.
struct TriangleValue {
  double squared = 0;  ///< squared distance, rounded
  double error = 0;    ///< |sqrt(squared) - true distance| is at most this
};

/// The nearest point of one triangle.
struct NearestOnTriangle {
  TriangleValue value;
  Point point = Point::Zero();
  /// In the order of `triangle`: above 0 for one corner at a vertex, two on an
  /// edge, three inside the face.
  std::array<double, 3> barycentric{};
  Feature feature = Feature::kFace;
};

/// How many triangles are evaluated at once.
inline constexpr std::size_t kTrianglesAtOnce = 4;

/// Below this squared sine of its largest angle a face is evaluated with 113 bits: double
/// would lose more than 5.
inline constexpr double kFlatFaceSine2 = 0x1p-10;
/// A squared normal below this has lost bits to underflow.
inline constexpr double kTinySquare = 0x1p-930;
/// Rounding of a value, as a multiple of (greatest corner distance) / sine: the cross product
/// loses 5 units of 2^-53, its dot products 3 more each, the inside test 2 * (4 + 5) across
/// an edge; 64 covers their sum.
inline constexpr double kValueErrorFactor = 64 * 0x1p-53;
/// Squares below 2^-1022 underflow; distances below this are not resolved.
inline constexpr double kAbsoluteValueError = 0x1p-500;
/// What is known of one triangle before any point is made of it. Corners are numbered in
/// lexicographic order; side k is opposite to corner k.
struct TriangleFinding {
  TriangleValue value;
  double number = 0;  ///< of the apex, or of the nearest side
  /// The nearest point is apex + first (its next corner - apex) + second (the last - apex),
  /// or, where `second` is kOnSide, at the share `first` of the side.
  double first = 0;
  double second = 0;

  static constexpr double kOnSide = -1;
};

/// Findings of triangles that were evaluated side by side.
struct TriangleFindings {
  alignas(32) double squared[kTrianglesAtOnce];
  alignas(32) double error[kTrianglesAtOnce];
  alignas(32) double number[kTrianglesAtOnce];
  alignas(32) double first[kTrianglesAtOnce];
  alignas(32) double second[kTrianglesAtOnce];

  TriangleFinding of(std::size_t lane) const {
    return {{squared[lane], error[lane]}, number[lane], first[lane], second[lane]};
  }
};

/// The nearest point that is told of; written where it is wanted, for to copy it takes longer.
void locate(const Triangle& triangle, const TriangleFinding& finding,
            NearestOnTriangle& nearest) noexcept;

/// The nearest point of `triangle` to `query`, in the model frame.
///
/// The value depends on the set of corners, not their order; where the nearest
/// point lies on an edge or a vertex, it depends on that edge or vertex alone,
/// so that all triangles sharing it have the same bits.
/// Triangles without area are the segment or point they are.
///
/// Method: the least of three segment distances and, where the projection
/// falls inside, the plane distance about the corner of the largest angle.
/// Where that angle is so flat that double would lose more than 5 bits, the
/// plane part is evaluated with 113 bits.
NearestOnTriangle nearest_on_triangle(const Point& query, const Triangle& triangle) noexcept;

/// Its value alone.
inline TriangleValue triangle_value(const Point& query, const Triangle& triangle) noexcept {
  return nearest_on_triangle(query, triangle).value;
}

}  // namespace planetree::octree
