#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/geometry/cell_grid.h"
#include "octree/page/mask_frame.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// What a lookup must know of a mask.
struct MaskInfo {
  std::uint32_t page_bytes = 0;
  std::uint32_t first_page = 0;
  std::uint32_t page_count = 0;  ///< 0: the model has no mask
  Point lower = Point::Zero();   ///< least corner of the model's box, model frame
};

/// One of the planes that lie side by side behind a page's records.
inline Triangle mask_plane(const double* planes, unsigned index) {
  const double* at = planes + std::size_t{kPlaneSlots} * index;
  return {Point(at[0], at[1], at[2]), Point(at[3], at[4], at[5]), Point(at[6], at[7], at[8])};
}

/// What the mask knows of a point.
struct MaskLookup {
  enum class Kind {
    kColour,   ///< white or black: only the sign of `winding` counts
    kPlanes,   ///< a special cell: `winding` and `on_surface`
    kCorners,  ///< a grey cell: `corners` of `cell`, or its `listed`
    kNothing,  ///< no mask, a page missing, or corners that were not counted
  };
  Kind kind = Kind::kNothing;
  int winding = 0;          ///< of the point moved by its infinitesimal step
  bool on_surface = false;  ///< then `winding` is of a step beside it
  GridCell cell;            ///< the smallest of the mask that was reached
  MaskCorners corners{};
  MaskListed listed{};  ///< of a cell that lists blocks: in place of its `corners`
  MaskBlocks blocks;    ///< its list; empty if it has none
};

/// Finds the cell of the mask that a point is in.
///
/// point      within the model's box, model frame.
/// max_work  most nodes to visit; no more than kLevels are needed.
/// threads    any; no allocation, no lock, no exception.
MaskLookup look_up(const MaskInfo& mask, const Point& point, std::uint64_t max_work,
                   const PageReader& pages, TraversalStats& work) noexcept;

}  // namespace planetree::octree
