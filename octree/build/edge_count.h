#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "octree/build/edge_crossings.h"

namespace planetree::octree {

/// The winding numbers of a cell's corners, counted along its edges.
class EdgeCount {
 public:
  /// All must outlive this.
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
  std::uint8_t sides_crossed(const BoxedTriangle& triangle) const;

  const std::array<Point, 8>& corners_;
  const std::int64_t winding_;
  const std::vector<BoxedTriangle>& triangles_;
  const std::vector<std::uint32_t>& positions_;
  std::vector<std::uint8_t> sides_;  // of each position
};

}  // namespace planetree::octree
