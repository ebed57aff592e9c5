#pragma once

#include <cstdint>

#include "octree/geometry/region.h"
#include "octree/mask/mask_lookup.h"
#include "octree/mask/side_grid.h"
#include "octree/traversal/tree_view.h"
#include "query/file/scale.h"
#include "storage/file/file_layout.h"

namespace planetree::query {

/// What answers need to know of a model besides its pages. Fixed once the side grid is filled;
/// any number of threads may read it. Lengths are in the model frame.
struct ModelGeometry {
  explicit ModelGeometry(const storage::FileHeader& header);

  Scale scale;
  octree::TreeInfo tree;
  octree::MaskInfo mask;
  octree::SideGrid side_grid;   ///< empty until filled
  octree::Region region;        ///< where the file holds the whole surface
  octree::Point region_corner;  ///< a point of the region; see region_winding
  std::int64_t region_winding;  ///< winding number at `region_corner`, of watertight models
  bool watertight;              ///< no edge is unbalanced
};

/// The part of space for which a file holds the whole surface, model frame.
octree::Region region_of(const storage::ModelRecord& model);

}  // namespace planetree::query
