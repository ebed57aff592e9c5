#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "octree/builder/surface/edge_crossings.h"

namespace planetree::octree {

/// Winding numbers at the corners of a cell, counted along the cell's edges.
class EdgeCount {
 public:
  /// Corners and triangles must outlive this.
  ///
  /// winding    number at the cell's least corner.
  /// triangles  those at `positions` are all that may touch the cell.
  EdgeCount(const std::array<Point, 8>& corners, std::int64_t winding,
            const std::vector<BoxedTriangle>& triangles,
            const std::vector<std::uint32_t>& positions);

  /// The winding numbers at all corners, in the order of octants.
  std::array<std::int64_t, 8> all() const;

  /// winding(which) - winding(before), for two corners that an edge joins; `before` is the lower
  /// one.
  std::int64_t rise(unsigned which, unsigned before) const;

 private:
  // A triangle that crosses the planes of at least two sides, as it must to cross an edge.
  struct Near {
    std::uint32_t position;
    unsigned sides;
  };
  unsigned sides_crossed(const BoxedTriangle& triangle) const;

  const std::array<Point, 8>& corners_;
  const std::int64_t winding_;
  const std::vector<BoxedTriangle>& triangles_;
  std::vector<Near> near_;
};

}  // namespace planetree::octree
