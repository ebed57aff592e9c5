#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tests/oracle/brute_force.h"

namespace planetree::oracle {

/// Returns -1 if the triangle is nearer to `query` than `distance`, which is finite, 0 if at this
/// distance, 1 if farther. Computed in long double with an error bound, then in integers.
int compare_distance(const Vec3& query, const Corners& triangle, double distance);

/// Compares distance intervals with every triangle: by its box first, then in long double with an
/// error bound, then in integers. As certain as exact_distance(), and a hundred times as fast.
class IntervalOracle {
 public:
  /// `triangles` must outlive this.
  explicit IntervalOracle(std::span<const Corners> triangles);

  /// Whether no triangle is nearer than `lower`.
  [[nodiscard]] bool none_nearer(const Vec3& query, double lower) const;
  /// Whether this triangle is at most `upper` away.
  [[nodiscard]] bool reaches(const Vec3& query, std::uint64_t triangle, double upper) const;

 private:
  struct Measured {
    Vec3 lower, upper;
    long double error;  ///< of extended_distance(), divided by the farthest corner's distance
  };
  [[nodiscard]] int compare(const Vec3& query, std::size_t triangle, double distance) const;

  std::span<const Corners> triangles_;
  std::vector<Measured> measured_;
};

}  // namespace planetree::oracle
