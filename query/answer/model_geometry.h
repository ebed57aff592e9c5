#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "octree/geometry/cell_grid.h"
#include "octree/mask/mask_lookup.h"
#include "octree/mask/side_grid.h"
#include "octree/traversal/tree_view.h"
#include "planetree/types.h"
#include "query/file/scale.h"
#include "storage/file/file_layout.h"

namespace planetree::query {

/// The data of a model that queries need besides its pages. It does not change after the side grid
/// is filled; then any number of threads may read it. Lengths are in the model frame.
struct ModelGeometry {
  explicit ModelGeometry(const storage::FileHeader& header);

  Scale scale;
  octree::TreeInfo tree;
  octree::MaskInfo mask;
  octree::SideGrid side_grid;   ///< empty until filled
  octree::Region region;        ///< part of space whose surface the file holds
  octree::Point region_corner;  ///< a point of the region; see region_winding
  std::int64_t region_winding;  ///< winding number at `region_corner`; only if watertight
  bool watertight;              ///< no edge is unbalanced
  /// Whether each SideRule decides sides by the nearest feature, for this file.
  std::array<bool, 3> by_surface;

  /// Whether the rule, which may be out of range, decides sides by the winding number.
  bool by_winding_number(SideRule rule) const noexcept {
    const auto at = static_cast<std::size_t>(rule);
    return at < by_surface.size() && !by_surface[at];
  }
};

/// Returns the part of space in which a file holds the whole surface, model frame.
octree::Region region_of(const storage::ModelRecord& model);

}  // namespace planetree::query
