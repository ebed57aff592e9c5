#pragma once

#include "octree/geometry/cell_grid.h"
#include "octree/geometry/region.h"

namespace planetree::octree {

/// Cells of the octree clipped to a region. Clipped cells are boxes too, and neighbours still share
/// sides. A cell beyond a wall is flat and lies within the wall.
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
  /// Returns the octant that a point of the region lies in; see CellGrid::octant().
  unsigned octant(const GridCell& cell, const Point& point) const {
    const Point middle = this->middle(cell);
    unsigned octant = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
      octant |= static_cast<unsigned>(middle[axis] <= point[axis]) << axis;
    return octant;
  }

  /// Returns whether the cell contains a point of the region. Callers use only such cells.
  bool has_part_of(const GridCell& cell) const {
    return region_.meets(grid_.lower(cell), grid_.upper(cell));
  }
  const Region& region() const { return region_; }

 private:
  CellGrid grid_;
  Region region_;
};

}  // namespace planetree::octree
