#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// Maximum coordinate of a stored surface point, in quanta.
inline constexpr unsigned kMaxFieldCoordinate = 65535;
/// A stored surface point is off the surface by at most this many quanta: rounding three
/// coordinates moves it by sqrt(3)/2. What is left covers the rounding of the search for it, 2^-8,
/// and of positions in the grid in float, 2^-6.
inline constexpr double kFieldUncertainty = 0.9375;

/// The surface point nearest to a grid point, in quanta from the grid's lower corner.
using FieldPoint = std::array<std::uint16_t, 3>;

/// Where the points of a coarse field lie. Lengths are in the model frame. Point (i, j, k) of the
/// grid is at lower + step (i, j, k). Points are in the order of k, then j, then i.
struct FieldShape {
  Point lower = Point::Zero();
  double step = 0;     ///< from point to point, along each axis
  double quantum = 0;  ///< unit of stored surface points
  std::array<std::uint32_t, 3> size{};

  /// Maximum number of points.
  static constexpr std::uint64_t kMaxPoints = std::uint64_t{1} << 20;
  /// Least number of triangles of a model that has a field. Fewer are found as fast.
  static constexpr std::uint64_t kMinTriangles = 1024;

  /// Returns the number of points; 0: there is no field.
  std::uint64_t count() const { return std::uint64_t{size[0]} * size[1] * size[2]; }
  std::uint64_t bytes() const { return count() * sizeof(FieldPoint); }
  /// Returns the bound on the distance from a stored surface point to the surface.
  double uncertainty() const { return kFieldUncertainty * quantum; }
  std::size_t index_of(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
    return (std::size_t{k} * size[1] + j) * size[0] + i;
  }
  /// Returns a grid point, relative to `lower`. Exact: step has few bits.
  Point at(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
    return step * Point(i, j, k);
  }
  /// The same by the number of the point.
  Point at(std::uint64_t number) const {
    return at(static_cast<std::uint32_t>(number % size[0]),
              static_cast<std::uint32_t>(number / size[0] % size[1]),
              static_cast<std::uint32_t>(number / size[0] / size[1]));
  }
  /// Returns a stored surface point, relative to `lower`. Exact likewise.
  Point surface_point(const FieldPoint& stored) const {
    return quantum * Point(stored[0], stored[1], stored[2]);
  }

  /// Returns the shape of every n-th of the points along each axis, from the first on.
  FieldShape thinned(std::uint32_t n) const;
  /// Returns the least n for which thinned(n) takes at most so many bytes. The grid loses up to n -
  /// 1 steps of its upper sides. It must still hold the core, so that n is at most a tenth of the
  /// cells along the longest edge, where the grid reaches beyond the core.
  std::uint32_t thinning_for(std::uint64_t max_bytes) const;

  /// Returns the shape for a model: a grid over its core, an eighth of its longest edge larger on
  /// each side.
  ///
  /// triangles  those in the file.
  static FieldShape of(const Point& core_lower, const Point& core_upper, std::uint64_t triangles);
};

}  // namespace planetree::octree
