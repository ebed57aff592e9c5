#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "planetree/types.h"

/// Distance from a point to a triangle, in double.
///
/// All answers of the library are decided here. The vectorised float kernels only tell which
/// triangles need not be evaluated.
namespace planetree::octree {

class WorkLimit;

using Point = Eigen::Vector3d;
using Triangle = std::array<Point, 3>;

/// Returns the least and the greatest corner of a triangle's box.
inline Point least_corner(const Triangle& triangle) {
  return triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]);
}
inline Point greatest_corner(const Triangle& triangle) {
  return triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2]);
}

/// Returns whether two corners are equal. Such a triangle has no face, and nothing crosses it.
inline bool has_equal_corners(const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  return a == b || b == c || c == a;
}

/// Returns the area of a triangle, in plain double.
inline double area_of(const Triangle& triangle) {
  const Point u = triangle[1] - triangle[0], v = triangle[2] - triangle[0];
  const Point normal(u.y() * v.z() - u.z() * v.y(), u.z() * v.x() - u.x() * v.z(),
                     u.x() * v.y() - u.y() * v.x());
  return 0.5 * normal.norm();
}

/// The value that triangles are compared by.
struct TriangleValue {
  double squared = 0;  ///< squared distance, rounded
  double error = 0;    ///< bound on |sqrt(squared) - true distance|
};

/// Nearest point on one triangle.
struct NearestOnTriangle {
  TriangleValue value;
  Point point = Point::Zero();
  /// In the order of the triangle's corners. Positive for one corner at a vertex, for two on an
  /// edge, for all three inside the face; 0 otherwise.
  std::array<double, 3> barycentric{};
  Feature feature = Feature::kFace;
};

/// Number of triangles that are evaluated together.
inline constexpr std::size_t kTrianglesAtOnce = 4;

/// Result of evaluating one triangle, before its nearest point is computed. Corners are numbered in
/// lexicographic order; side k is opposite to corner k.
struct TriangleResult {
  TriangleValue value;
  double number = 0;  ///< number of the apex, or of the nearest side
  /// On a face, the nearest point is apex + first * (u - apex) + second * (v - apex), with u and v
  /// the other corners in order. On a side, `second` is kOnSide and the point divides the side at
  /// the share `first`.
  double first = 0;
  double second = 0;

  static constexpr double kOnSide = -1;
};

/// Results of triangles that were evaluated together, one a lane.
struct TriangleResults {
  alignas(32) double squared[kTrianglesAtOnce];
  alignas(32) double error[kTrianglesAtOnce];
  alignas(32) double number[kTrianglesAtOnce];
  alignas(32) double first[kTrianglesAtOnce];
  alignas(32) double second[kTrianglesAtOnce];

  TriangleResult of(std::size_t lane) const {
    return {{squared[lane], error[lane]}, number[lane], first[lane], second[lane]};
  }
};

/// Computes the nearest point that `finding` describes. Writes to a parameter because copying the
/// result would take longer.
void locate(const Triangle& triangle, const TriangleResult& result,
            NearestOnTriangle& nearest) noexcept;

/// Returns the nearest point of `triangle` to `query`, both in the model frame.
///
/// The value depends on the set of corners, not on their order. If the nearest point lies on an
/// edge or a vertex, the value depends on that edge or vertex alone, so that all triangles that
/// share it yield the same bits. A triangle without area is evaluated as a segment or a point.
///
/// Method: the least of three segment distances and, where the projection falls inside, of the
/// plane distance about the corner of the largest angle. If that angle is so flat that double would
/// lose more than 5 bits, the plane distance is evaluated with 113 bits.
NearestOnTriangle nearest_on_triangle(const Point& query, const Triangle& triangle) noexcept;

/// Does the same within a limit of work, which is charged for flat faces alone. Returns false if
/// the limit refuses; `nearest` then has no meaning.
bool nearest_on_triangle(const Point& query, const Triangle& triangle, WorkLimit& limit,
                         NearestOnTriangle& nearest) noexcept;

/// Returns whether nearest_on_triangle() may evaluate the triangle's face with 113 bits, which
/// takes WorkUnits::kFlatFace.
bool may_be_flat(const Triangle& triangle) noexcept;

/// Returns the value of nearest_on_triangle().
inline TriangleValue triangle_value(const Point& query, const Triangle& triangle) noexcept {
  return nearest_on_triangle(query, triangle).value;
}

/// kTrianglesAtOnce triangles of TriangleRows. Coordinates are ordered by corner and axis, `stride`
/// doubles apart.
struct TriangleView {
  const double* at;
  std::size_t stride;

  Triangle triangle(std::size_t i) const {
    Triangle corners;
    copy_triangle(i, corners);
    return corners;
  }
  void copy_triangle(std::size_t i, Triangle& corners) const {
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis)
        corners[k][static_cast<Eigen::Index>(axis)] = at[(3 * k + axis) * stride + i];
  }
};

/// Triangles as a structure of arrays, for kernels that process several at once. Entries that were
/// never set are uninitialised.
template <std::size_t kMax>
struct TriangleRows {
  static_assert(kMax % kTrianglesAtOnce == 0);

  alignas(kTrianglesAtOnce * sizeof(double)) double at[3][3][kMax];  ///< corner, axis, triangle

  Triangle triangle(std::size_t i) const { return view(0).triangle(i); }
  /// Returns the triangles from `first` on, a multiple of kTrianglesAtOnce.
  TriangleView view(std::size_t first) const { return {at[0][0] + first, kMax}; }

  void set(std::size_t i, const Triangle& corners) {
    for (std::size_t k = 0; k < 3; ++k)
      for (Eigen::Index axis = 0; axis < 3; ++axis) at[k][axis][i] = corners[k][axis];
  }

  /// Sets the kTrianglesAtOnce entries from `i` on, a multiple of kTrianglesAtOnce, to one
  /// triangle.
  void fill(std::size_t i, const Triangle& corners) {
    for (std::size_t k = 0; k < 3; ++k)
      for (Eigen::Index axis = 0; axis < 3; ++axis)
        for (std::size_t lane = 0; lane < kTrianglesAtOnce; ++lane)
          at[k][axis][i + lane] = corners[k][axis];
  }

  void copy(std::size_t from, std::size_t to) {
    for (auto& corner : at)
      for (auto& row : corner) row[to] = row[from];
  }
};

/// Evaluates the triangle with a bit in `triangle` again with 113 bits. evaluate_triangles() found
/// its face too flat for double.
void refine_flat(const Point& query, const TriangleView& triangles, unsigned triangle,
                 TriangleResults& results) noexcept;

}  // namespace planetree::octree
