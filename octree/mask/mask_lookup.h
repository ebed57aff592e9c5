#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/geometry/cell_grid.h"
#include "octree/page/mask_frame.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// Facts of a mask that a lookup needs.
struct MaskInfo {
  std::uint32_t page_bytes = 0;
  std::uint32_t first_page = 0;
  std::uint32_t page_count = 0;  ///< 0: the model has no mask
  Point lower = Point::Zero();   ///< least corner of the model's box, model frame
};

/// Returns a triangle in plane `index` of the planes that follow a page's records.
inline Triangle mask_plane(const double* planes, unsigned index) {
  const double* at = planes + std::size_t{kPlaneSlots} * index;
  return {Point(at[0], at[1], at[2]), Point(at[3], at[4], at[5]), Point(at[6], at[7], at[8])};
}

/// What the mask knows about a point.
struct MaskLookup {
  enum class Kind {
    kColour,   ///< a white, black or inverted cell: only the sign of `winding` has a meaning
    kPlanes,   ///< a special cell: `winding` and `on_surface` are known
    kCorners,  ///< a grey cell: `corners` of `cell` are known, or `listed` and `blocks`
    kNothing,  ///< nothing: no mask, a page or work is missing, or the corners are not stated
  };
  Kind kind = Kind::kNothing;
  int winding = 0;          ///< of the perturbed point
  bool on_surface = false;  ///< the point itself is on the surface
  GridCell cell;            ///< the smallest cell of the mask that was reached
  MaskCorners corners{};    ///< corner numbers of `cell`, if it is not listed
  MaskListed listed{};      ///< record of a listed cell, which has its corner numbers
  MaskBlocks blocks;        ///< list of a listed cell; else empty
};

/// Finds the cell of the mask that a point is in.
///
/// point     within the model's box, model frame.
/// max_work  maximum number of nodes to visit; kLevels always suffice.
/// work      counters that the lookup adds to.
/// threads   any; no allocation, no lock, no exception.
MaskLookup look_up(const MaskInfo& mask, const Point& point, std::uint64_t max_work,
                   const PageReader& pages, TraversalStats& work) noexcept;

}  // namespace planetree::octree
