#pragma once

#include <array>
#include <cstdint>

namespace planetree::tools {

using Corners = std::array<std::uint64_t, 3>;

/// A point of a cubic lattice.
struct LatticePoint {
  std::uint64_t i = 0, j = 0, k = 0;
  bool operator==(const LatticePoint&) const = default;
};

/// Maps a lattice coordinate in 0 ... n to -1 ... 1. Both ends and the middle are exact.
double centred_coordinate(std::uint64_t coordinate, std::uint64_t n);

/// The points of an (n + 1) x (n + 1) grid, row by row, and its 2 n^2 triangles, cell by cell,
/// counter-clockwise with i to the right and j up.
///
/// The diagonal of each cell runs towards the middle of the grid. Unless n is 1, no triangle then
/// has all its corners on the rim. The corner triangles of a disc made from the grid therefore do
/// not collapse, and two grids may share a rim.
class GridLattice {
 public:
  /// n is from 1 to 2^20, so that no count below overflows.
  explicit GridLattice(std::uint64_t n) : n_(n) {}

  std::uint64_t n() const { return n_; }
  std::uint64_t point_count() const { return (n_ + 1) * (n_ + 1); }
  std::uint64_t triangle_count() const { return 2 * n_ * n_; }

  /// The point of an index; k is 0.
  LatticePoint point(std::uint64_t index) const { return {index % (n_ + 1), index / (n_ + 1), 0}; }
  std::uint64_t index(std::uint64_t i, std::uint64_t j) const { return j * (n_ + 1) + i; }
  std::array<LatticePoint, 3> triangle(std::uint64_t index) const;

 private:
  std::uint64_t n_;
};

/// The lattice points on the surface of [0, n]^3 and the 12 n^2 triangles between them,
/// counter-clockwise seen from outside: closed and edge-manifold.
///
/// Points and triangles are numbered layer by layer from k = 0 to k = n. Layers 0 and n are grids.
/// Each layer between is a ring of 4 n points that starts at (0, 0, k) and runs counter-clockwise
/// seen from above.
class CubeLattice {
 public:
  /// n is from 1 to 2^20, so that no count below overflows.
  explicit CubeLattice(std::uint64_t n) : grid_(n) {}

  std::uint64_t n() const { return grid_.n(); }
  std::uint64_t point_count() const { return 6 * n() * n() + 2; }
  std::uint64_t triangle_count() const { return 12 * n() * n(); }

  LatticePoint point(std::uint64_t index) const;
  Corners triangle(std::uint64_t index) const;

 private:
  std::uint64_t top_start() const { return point_count() - grid_.point_count(); }
  LatticePoint ring_point(std::uint64_t step) const;
  std::uint64_t ring_index(std::uint64_t step, std::uint64_t k) const;
  Corners cap_triangle(std::uint64_t index, bool top) const;
  Corners side_triangle(std::uint64_t index) const;

  GridLattice grid_;
};

/// Two (n + 1) x (n + 1) grids that share their rim, one facing up and one down: 4 n^2 triangles,
/// closed and edge-manifold. Points are numbered from the upper grid to the inner points of the
/// lower one, row by row.
class PillowLattice {
 public:
  /// n is even, from 2 to 2^20, so that there is a middle and no count overflows.
  explicit PillowLattice(std::uint64_t n) : grid_(n) {}

  std::uint64_t n() const { return grid_.n(); }
  std::uint64_t point_count() const { return 2 * n() * n() + 2; }
  std::uint64_t triangle_count() const { return 4 * n() * n(); }

  /// The point of an index; k is 1 for inner points of the upper grid, else 0.
  LatticePoint point(std::uint64_t index) const;
  Corners triangle(std::uint64_t index) const;

 private:
  bool on_rim(std::uint64_t i, std::uint64_t j) const {
    return i == 0 || j == 0 || i == n() || j == n();
  }
  std::uint64_t lower_index(std::uint64_t i, std::uint64_t j) const;

  GridLattice grid_;
};

}  // namespace planetree::tools
