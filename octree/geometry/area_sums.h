#pragma once

#include <array>
#include <cstdint>

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// Sums of the area vectors of triangles and of their areas. They tell how open a surface is: its
/// *openness* is the length of the sum of the vectors, divided by the sum of the areas. The area
/// vectors of a closed surface sum to zero; of any surface, they sum to what would close it. So the
/// openness is 0 for a closed surface and 1 for a flat sheet. It is 2 / pi for a half pipe, 1/2 for
/// a hemisphere, 1/3 for a tetrahedron and 1/5 for a cube less one face, and near 0 for a closed
/// surface with many small holes.
///
/// Strays do not count: one wrong coordinate would outweigh a whole scan. Sums are whole numbers,
/// so that they do not depend on the order of the triangles. Triangles of an area below 2^-60 in
/// the model frame do not count.
class AreaSums {
 public:
  /// lower, upper  the core, model frame
  AreaSums(const Point& lower, const Point& upper) : lower_(lower), upper_(upper) {}

  /// Least openness of a surface that is taken for a sheet, if it is not watertight. It lies
  /// between that of a tetrahedron less one face and that of a hemisphere.
  static constexpr double kOpennessOfSheet = 0.375;

  /// Adds a triangle, model frame. Add each triangle once.
  void add(const Triangle& triangle);
  /// Adds the triangles that were added to other sums.
  void add(const AreaSums& other);

  /// The sums as numbers that can be stored: of each the low half, then the high half.
  using Words = std::array<std::uint64_t, 8>;
  [[nodiscard]] Words words() const;
  /// Adds sums that were stored.
  void add(const Words& words);

  /// Returns the openness, 0 to 1; 0 if no triangle has area.
  [[nodiscard]] double openness() const;

 private:
  __extension__ using Int128 = __int128;
  __extension__ using Word128 = unsigned __int128;

  static constexpr double kUnit = 0x1p-60;
  /// Limit of an area and of the components of an area vector. Triangles of the core have less,
  /// unless a file is forged. In units it fits 63 bits, so that 2^64 triangles fit 128.
  static constexpr double kMaxArea = 7;
  static std::int64_t whole(double area);

  bool is_in_core(const Triangle& triangle) const;

  const Point lower_, upper_;
  Int128 vector_[3] = {0, 0, 0};
  Int128 area_ = 0;
};

}  // namespace planetree::octree
