#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "planetree/build.h"
#include "planetree/types.h"

/// @file
/// Conversions between planetree and Eigen. A program that uses the library needs Eigen only if it
/// includes this header. A matrix or vector of a wrong size fails an `eigen_assert`; with NDEBUG it
/// is undefined behaviour. Functions that return a std::vector may throw std::bad_alloc.

namespace planetree {

/// Converts a position or a direction to an Eigen vector.
inline Eigen::Vector3d to_eigen(const Vec3& v) { return {v.x, v.y, v.z}; }

/// Converts a row or column vector of three numbers to a position or a direction. Numbers that are
/// not double are converted to double.
template <class Derived>
Vec3 to_vec3(const Eigen::DenseBase<Derived>& v) {
  static_assert(Derived::IsVectorAtCompileTime, "a vector is needed");
  eigen_assert(v.size() == 3);
  return {static_cast<double>(v(0)), static_cast<double>(v(1)), static_cast<double>(v(2))};
}

static_assert(std::is_standard_layout_v<Vec3> && sizeof(Vec3) == 3 * sizeof(double),
              "an array of Vec3 is an array of doubles");

/// Returns a view of points as the columns of a 3 x N matrix. It copies nothing. The view is valid
/// as long as the points are.
inline Eigen::Map<const Eigen::Matrix3Xd> columns_of(std::span<const Vec3> points) {
  return {reinterpret_cast<const double*>(points.data()), 3,
          static_cast<Eigen::Index>(points.size())};
}

/// Copies points from the columns of a 3 x N matrix.
template <class Derived>
std::vector<Vec3> points_of_columns(const Eigen::DenseBase<Derived>& matrix) {
  eigen_assert(matrix.rows() == 3);
  std::vector<Vec3> points(static_cast<std::size_t>(matrix.cols()));
  for (Eigen::Index i = 0; i < matrix.cols(); ++i)
    points[static_cast<std::size_t>(i)] = to_vec3(matrix.col(i));
  return points;
}

/// Copies points from the rows of an N x 3 matrix, the usual form of a mesh's vertices.
template <class Derived>
std::vector<Vec3> points_of_rows(const Eigen::DenseBase<Derived>& matrix) {
  eigen_assert(matrix.cols() == 3);
  std::vector<Vec3> points(static_cast<std::size_t>(matrix.rows()));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    points[static_cast<std::size_t>(i)] = to_vec3(matrix.row(i));
  return points;
}

/// Copies triangles from the rows of an N x 3 matrix of vertex indices, the usual form of a mesh's
/// faces. An index outside of the range of std::uint32_t, such as -1, becomes 2^32 - 1. build()
/// then skips the triangle, unless the mesh has 2^32 vertices.
template <class Derived>
std::vector<TriangleVertices> triangles_of_rows(const Eigen::DenseBase<Derived>& matrix) {
  using Index = typename Derived::Scalar;
  static_assert(std::is_integral_v<Index>, "indices are needed");
  eigen_assert(matrix.cols() == 3);
  constexpr std::uint32_t kMax = std::numeric_limits<std::uint32_t>::max();
  const auto index_of = [](Index index) {
    return std::in_range<std::uint32_t>(index) ? static_cast<std::uint32_t>(index) : kMax;
  };
  std::vector<TriangleVertices> triangles(static_cast<std::size_t>(matrix.rows()));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    triangles[static_cast<std::size_t>(i)] = {
        index_of(matrix.coeff(i, 0)), index_of(matrix.coeff(i, 1)), index_of(matrix.coeff(i, 2))};
  return triangles;
}

}  // namespace planetree
