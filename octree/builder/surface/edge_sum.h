#pragma once

#include <cstdint>

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// Tells whether a surface is watertight, as EdgeBalance defines it, from its triangles in any
/// order and in constant memory. An edge adds a hash of its ends in one direction and subtracts it
/// in the other. The sum is zero if as many faces run along every edge in one direction as in the
/// other; of surfaces where that does not hold, one in 2^128 has the sum zero too.
class EdgeSum {
 public:
  /// Adds the edges of a triangle. Add each triangle once, all in the same frame, with +0 for
  /// zeros.
  void add(const Triangle& triangle);
  /// Adds one edge of a triangle, which runs from `from` to `to`.
  void add_edge(const Point& from, const Point& to);
  /// Adds the edges that were added to another sum.
  void add(const EdgeSum& other);

  [[nodiscard]] bool is_watertight() const { return low_ == 0 && high_ == 0; }

 private:
  std::uint64_t low_ = 0, high_ = 0;  // modulo 2^128
};

}  // namespace planetree::octree
