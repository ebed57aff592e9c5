#pragma once

#include <cstdint>
#include <mutex>

#include "octree/builder/sort/triangles.h"
#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// Measures how open a surface is: the length of the sum of the triangles' area vectors, divided by
/// the sum of their areas. The area vectors of a closed surface sum to zero; of any surface, they
/// sum to what would close it. So the measure is 0 for a closed surface and 1 for a flat sheet. It
/// is 2 / pi for a half pipe, 1/2 for a hemisphere, 1/3 for a tetrahedron and 1/5 for a cube less
/// one face, and near 0 for a closed surface with many small holes.
///
/// Sums are whole numbers, so that they do not depend on the order of the triangles. Triangles of
/// an area below 2^-60 in the model frame do not count, and of strays no more than kMaxArea counts.
class Openness {
 public:
  /// Least measure of an open surface that is taken for a sheet. It lies between that of a
  /// tetrahedron less one face and that of a hemisphere.
  static constexpr double kOfSheet = 0.375;

  /// Adds a part of the model, each part once. Any number of threads.
  void add(const Triangles& part);

  /// Returns the measure, 0 to 1; 0 if no triangle has area.
  double value() const;

 private:
  __extension__ using Int128 = __int128;

  /// Sums in units of kUnit.
  struct Sums {
    Int128 vector[3] = {0, 0, 0};
    Int128 area = 0;

    void add(const Triangle& triangle);
    void add(const Sums& other);
  };

  static constexpr double kUnit = 0x1p-60;
  /// Limit of an area and of the components of an area vector. Triangles of the core have less. In
  /// units it fits 63 bits, so that 2^64 triangles fit 128.
  static constexpr double kMaxArea = 7;
  static std::int64_t whole(double area);

  mutable std::mutex mutex_;
  Sums sums_;
};

}  // namespace planetree::octree
