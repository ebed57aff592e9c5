#pragma once

#include <array>
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

/// The value of `triangle` for `query`, in the model frame.
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
TriangleValue triangle_value(const Point& query, const Triangle& triangle) noexcept;

/// The same value with all that is known of it.
NearestOnTriangle nearest_on_triangle(const Point& query, const Triangle& triangle) noexcept;

}  // namespace planetree::octree
