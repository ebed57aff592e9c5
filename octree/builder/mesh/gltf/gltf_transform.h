#pragma once

#include <array>
#include <cmath>

#include "octree/geometry/strict_math.h"
#include "planetree/types.h"

namespace planetree::octree {

/// An affine map of positions, in double precision: the first three rows of a matrix.
struct GltfTransform {
  std::array<std::array<double, 4>, 3> rows = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  [[nodiscard]] Vec3 of(const Vec3& p) const {
    const auto row = [&p](const std::array<double, 4>& r) {
      return r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3];
    };
    return {row(rows[0]), row(rows[1]), row(rows[2])};
  }

  [[nodiscard]] bool is_identity() const { return rows == GltfTransform().rows; }

  [[nodiscard]] bool is_finite() const {
    for (const auto& row : rows)
      for (const double value : row)
        if (!std::isfinite(value)) return false;
    return true;
  }

  /// Whether floats stay floats: the map exchanges axes and signs, and does not move.
  [[nodiscard]] bool keeps_floats() const {
    for (const auto& row : rows) {
      int units = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        if (std::fabs(row[i]) == 1) ++units;
        if (row[i] != 0 && std::fabs(row[i]) != 1) return false;
      }
      if (units != 1 || row[3] != 0) return false;
    }
    return true;
  }

  /// Whether the map turns triangles inside out.
  [[nodiscard]] bool mirrors() const {
    const auto& [a, b, c] = rows;
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]) <
           0;
  }
};

/// The map that applies `inner`, then `outer`.
inline GltfTransform operator*(const GltfTransform& outer, const GltfTransform& inner) {
  GltfTransform product;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& o = outer.rows[i];
    for (std::size_t j = 0; j < 4; ++j)
      product.rows[i][j] = o[0] * inner.rows[0][j] + o[1] * inner.rows[1][j] +
                           o[2] * inner.rows[2][j] + (j == 3 ? o[3] : 0);
  }
  return product;
}

/// The map of a node that has a translation, a rotation (a quaternion x, y, z, w of any length but
/// zero) and a scale. They apply in the order scale, rotation, translation.
inline GltfTransform transform_of(const Vec3& translation, const std::array<double, 4>& rotation,
                                  const Vec3& scale) {
  const double norm = std::sqrt(rotation[0] * rotation[0] + rotation[1] * rotation[1] +
                                rotation[2] * rotation[2] + rotation[3] * rotation[3]);
  const double x = rotation[0] / norm, y = rotation[1] / norm, z = rotation[2] / norm,
               w = rotation[3] / norm;
  GltfTransform made;
  made.rows = {{{(1 - 2 * (y * y + z * z)) * scale.x, 2 * (x * y - z * w) * scale.y,
                 2 * (x * z + y * w) * scale.z, translation.x},
                {2 * (x * y + z * w) * scale.x, (1 - 2 * (x * x + z * z)) * scale.y,
                 2 * (y * z - x * w) * scale.z, translation.y},
                {2 * (x * z - y * w) * scale.x, 2 * (y * z + x * w) * scale.y,
                 (1 - 2 * (x * x + y * y)) * scale.z, translation.z}}};
  return made;
}

}  // namespace planetree::octree
