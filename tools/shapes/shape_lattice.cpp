#include "tools/shapes/shape_lattice.h"

#include <cassert>

namespace planetree::tools {

double centred_coordinate(std::uint64_t coordinate, std::uint64_t n) {
  const auto twice = static_cast<double>(2 * coordinate);
  const auto size = static_cast<double>(n);
  return (twice - size) / size;
}

std::array<LatticePoint, 3> GridLattice::triangle(std::uint64_t index) const {
  assert(index < triangle_count());
  const std::uint64_t cell = index / 2;
  const bool second = index % 2 != 0;
  const std::uint64_t i = cell % n_;
  const std::uint64_t j = cell / n_;
  const LatticePoint low_left{i, j, 0}, low_right{i + 1, j, 0};
  const LatticePoint high_left{i, j + 1, 0}, high_right{i + 1, j + 1, 0};
  const bool left_half = 2 * i < n_;
  const bool low_half = 2 * j < n_;
  if (left_half == low_half) {
    return second ? std::array{low_left, high_right, high_left}
                  : std::array{low_left, low_right, high_right};
  }
  return second ? std::array{low_right, high_right, high_left}
                : std::array{low_left, low_right, high_left};
}

LatticePoint CubeLattice::ring_point(std::uint64_t step) const {
  const std::uint64_t n = grid_.n();
  if (step < n) return {step, 0, 0};
  if (step < 2 * n) return {n, step - n, 0};
  if (step < 3 * n) return {3 * n - step, n, 0};
  return {0, 4 * n - step, 0};
}

LatticePoint CubeLattice::point(std::uint64_t index) const {
  assert(index < point_count());
  const std::uint64_t n = grid_.n();
  if (index < grid_.point_count()) return grid_.point(index);
  if (index >= top_start()) {
    LatticePoint point = grid_.point(index - top_start());
    point.k = n;
    return point;
  }
  const std::uint64_t beyond_bottom = index - grid_.point_count();
  LatticePoint point = ring_point(beyond_bottom % (4 * n));
  point.k = 1 + beyond_bottom / (4 * n);
  return point;
}

std::uint64_t CubeLattice::ring_index(std::uint64_t step, std::uint64_t k) const {
  const std::uint64_t n = grid_.n();
  if (k > 0 && k < n) return grid_.point_count() + (k - 1) * 4 * n + step;
  const LatticePoint point = ring_point(step);
  return grid_.index(point.i, point.j) + (k == 0 ? 0 : top_start());
}

Corners CubeLattice::cap_triangle(std::uint64_t index, bool top) const {
  const auto [a, b, c] = grid_.triangle(index);
  const std::uint64_t start = top ? top_start() : 0;
  const Corners corners = {start + grid_.index(a.i, a.j), start + grid_.index(b.i, b.j),
                           start + grid_.index(c.i, c.j)};
  // The grid faces up, but the bottom of the cube faces down.
  return top ? corners : Corners{corners[0], corners[2], corners[1]};
}

Corners CubeLattice::side_triangle(std::uint64_t index) const {
  const std::uint64_t ring_steps = 4 * grid_.n();
  const std::uint64_t cell = index / 2;
  const std::uint64_t step = cell % ring_steps;
  const std::uint64_t next = step + 1 == ring_steps ? 0 : step + 1;
  const std::uint64_t k = cell / ring_steps;
  const std::uint64_t low = ring_index(step, k);
  const std::uint64_t high_next = ring_index(next, k + 1);
  if (index % 2 == 0) return {low, ring_index(next, k), high_next};
  return {low, high_next, ring_index(step, k + 1)};
}

Corners CubeLattice::triangle(std::uint64_t index) const {
  assert(index < triangle_count());
  const std::uint64_t cap_triangles = grid_.triangle_count();
  if (index < cap_triangles) return cap_triangle(index, false);
  const std::uint64_t top_start = triangle_count() - cap_triangles;
  if (index >= top_start) return cap_triangle(index - top_start, true);
  return side_triangle(index - cap_triangles);
}

LatticePoint PillowLattice::point(std::uint64_t index) const {
  assert(index < point_count());
  if (index < grid_.point_count()) {
    LatticePoint point = grid_.point(index);
    point.k = on_rim(point.i, point.j) ? 0 : 1;
    return point;
  }
  const std::uint64_t inner = index - grid_.point_count();
  return {1 + inner % (n() - 1), 1 + inner / (n() - 1), 0};
}

std::uint64_t PillowLattice::lower_index(std::uint64_t i, std::uint64_t j) const {
  if (on_rim(i, j)) return grid_.index(i, j);
  return grid_.point_count() + (j - 1) * (n() - 1) + (i - 1);
}

Corners PillowLattice::triangle(std::uint64_t index) const {
  assert(index < triangle_count());
  if (index < grid_.triangle_count()) {
    const auto [a, b, c] = grid_.triangle(index);
    return {grid_.index(a.i, a.j), grid_.index(b.i, b.j), grid_.index(c.i, c.j)};
  }
  const auto [a, b, c] = grid_.triangle(index - grid_.triangle_count());
  return {lower_index(a.i, a.j), lower_index(c.i, c.j), lower_index(b.i, b.j)};
}

}  // namespace planetree::tools
