#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "octree/builder/surface/edge_crossings.h"

namespace planetree::octree {

/// The winding numbers of a cell's corners, counted along its edges.
class EdgeCount {
 public:
  /// Corners and triangles must outlive this.
  /// winding    at the cell's least corner.
  /// triangles  of which those at `positions` are all that may touch the cell.
  EdgeCount(const std::array<Point, 8>& corners, std::int64_t winding,
            const std::vector<BoxedTriangle>& triangles,
            const std::vector<std::uint32_t>& positions);

  /// From the least corner on.
  std::array<std::int64_t, 8> all() const;

  /// winding(which) - winding(before), of corners of which an edge leads down from the one to the
  /// other.
  std::int64_t rise(unsigned which, unsigned before) const;

 private:
  // A triangle that crosses the planes of two sides at least, as an edge has to.
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
