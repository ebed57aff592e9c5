#pragma once

#include <array>
#include <cstdint>

#include "octree/attributes/attribute_page.h"
#include "octree/field/coarse_field.h"
#include "octree/geometry/cell_grid.h"
#include "octree/mask/cap_grid.h"
#include "octree/mask/mask_lookup.h"
#include "octree/mask/side_grid.h"
#include "octree/traversal/tree_view.h"
#include "planetree/types.h"
#include "query/file/open_layers.h"
#include "query/file/scale.h"
#include "storage/file/file_layout.h"

namespace planetree::query {

/// What decides the sides of a model by a SideRule.
enum class SideMeans : std::uint8_t {
  kFront,          ///< the nearest feature, or the rule is out of range
  kWindingNumber,  ///< the winding number
  kNothing,        ///< it would be the winding number, but the side layer is not opened
};

/// Where the attributes of triangles are; empty if their layer is not open.
struct AttributePages {
  octree::AttributeShape shape;
  std::uint32_t first_page = 0;
  std::uint32_t in_page = 0;      ///< triangles in a page; the last may have fewer
  std::uint64_t index_count = 0;  ///< of the mesh
};

/// The data of a model that queries need besides its pages. It does not change after the side grid
/// is filled; then any number of threads may read it. Lengths are in the model frame.
struct ModelGeometry {
  ModelGeometry(const storage::FileHeader& header, const OpenLayers& opened);
  ModelGeometry(const ModelGeometry&) = delete;  // `tree` points to `caps`
  ModelGeometry& operator=(const ModelGeometry&) = delete;

  Scale scale;
  octree::TreeInfo tree;  ///< tree.caps is null if there are no caps or they are not opened
  octree::TreeInfo caps;
  octree::MaskInfo mask;
  octree::SideGrid side_grid;  ///< empty until filled
  octree::CoarseField field;   ///< tells nothing until filled
  octree::CapGrid cap_grid;    ///< if there are caps, nothing is clear until it is filled
  AttributePages attributes;
  octree::Region region;        ///< part of space whose surface the file holds
  octree::Point region_corner;  ///< a point of the region; see region_winding
  double diagonal;              ///< of the core
  double cap_area;              ///< sum of the caps' areas
  std::int64_t region_winding;  ///< winding number at `region_corner`, caps included

  SideMeans side_means(SideRule rule) const noexcept {
    return side_means_[static_cast<std::uint8_t>(rule)];
  }

 private:
  std::array<SideMeans, 256> side_means_{};  // of each value that a SideRule may have
};

/// Returns the part of space in which a file holds the whole surface, model frame.
octree::Region region_of(const storage::ModelRecord& model);

}  // namespace planetree::query
