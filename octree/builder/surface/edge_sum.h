#pragma once

#include <cstdint>

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// Tells whether a surface closes, as EdgeBalance defines it, from its triangles in any order
/// and in constant memory: every edge adds a hash of its ends one way and takes it away the
/// other. So the sum is zero if, and but for one case in 2^128 only if, as many faces run along
/// every edge one way as the other.
class EdgeSum {
 public:
  /// The edges of one triangle; each triangle once, all in the same frame, zeros being +0.
  void add(const Triangle& triangle);
  /// Those of other triangles.
  void add(const EdgeSum& other);

  [[nodiscard]] bool is_watertight() const { return low_ == 0 && high_ == 0; }

 private:
  void add_edge(const Point& from, const Point& to);

  std::uint64_t low_ = 0, high_ = 0;  // modulo 2^128
};

}  // namespace planetree::octree
