#pragma once

#include "octree/geometry/cell_grid.h"
#include "octree/geometry/region.h"

namespace planetree::octree {

/// The octree's cells as far as they are in a region: boxes too, and side by side as the cells
/// are. One that is beyond a wall is flat, within it.
class ClippedGrid {
 public:
  explicit ClippedGrid(const Point& lower, const Region& region = {})
      : grid_(lower), region_(region) {}

  Point lower(const GridCell& cell) const { return corner(cell, 0); }
  Point upper(const GridCell& cell) const { return corner(cell, 7); }
  Point corner(const GridCell& cell, unsigned which) const {
    return region_.clamped(grid_.corner(cell, which));
  }
  Point middle(const GridCell& cell) const { return region_.clamped(grid_.middle(cell)); }
  /// As CellGrid::octant(), of a point in the region.
  unsigned octant(const GridCell& cell, const Point& point) const {
    const Point middle = this->middle(cell);
    unsigned octant = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
      octant |= static_cast<unsigned>(middle[axis] <= point[axis]) << axis;
    return octant;
  }

  /// Whether some point of the region is in the cell: of others nobody asks.
  bool has_part_of(const GridCell& cell) const {
    return region_.meets(grid_.lower(cell), grid_.upper(cell));
  }
  const Region& region() const { return region_; }

 private:
  CellGrid grid_;
  Region region_;
};

}  // namespace planetree::octree
