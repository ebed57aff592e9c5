#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

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

/// Evaluates the triangles with a bit in `flat` again with 113 bits. evaluate_triangles() found
/// their faces too flat for double.
void refine_flat(const Point& query, const TriangleView& triangles, unsigned flat,
                 TriangleResults& results) noexcept;

}  // namespace planetree::octree
