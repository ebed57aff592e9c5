#pragma once

#include <cstdint>
#include <optional>

#include "octree/geometry/cell_grid.h"
#include "octree/mask/mask_lookup.h"
#include "octree/traversal/tree_view.h"
#include "planetree/types.h"
#include "query/answer/model_geometry.h"
#include "query/answer/side_cache.h"

namespace planetree::query {

/// How a side was found, for reports.
struct SideReason {
  enum class Rule : std::uint8_t {
    kNone,           ///< the side is unknown
    kRegion,         ///< the side cannot be known: the file is of a region, and the point is beyond
                     ///< a wall or the model is not watertight
    kOutsideBox,     ///< the point is outside of the model's box
    kColour,         ///< `cell` is white, black or inverted
    kPlanes,         ///< `cell` is special
    kSlab,           ///< the point is beyond a plane of the slab of `cell`
    kCorner,         ///< `crossings` to `end`, a corner of `cell`
    kWayOut,         ///< `crossings` to `end`, which is outside of the model's box or is
                     ///< ModelGeometry::region_corner
    kWindingNumber,  ///< the model is not watertight: `value`, right within `error`
  };
  Rule rule = Rule::kNone;
  octree::GridCell cell;  ///< the smallest cell of the mask that was reached
  bool in_mask = false;   ///< the model has a mask, so that `cell` has a meaning
  octree::Point end = octree::Point::Zero();  ///< model frame
  std::int64_t known = 0;                     ///< winding number at `end`
  std::int64_t crossings = 0;                 ///< its change from `end` to the point
  double value = 0;                           ///< winding number of the point
  double error = 0;                           ///< error bound of `value`
};

/// Finds the side of a model's surface that a point is on.
///
/// point     model frame
/// max_work  maximum number of nodes and blocks to visit
/// work      counters that the search adds to
/// reason    receives how the side was found; may be null
/// return    kUnknown if degraded or if the side cannot be known (Rule::kRegion); also if the model
///           is not watertight and the winding number is one half up to rounding
SideResult find_side(const ModelGeometry& model, const octree::Point& point, std::uint64_t max_work,
                     const octree::PageReader& pages, octree::TraversalStats& work,
                     SideReason* reason = nullptr) noexcept;

/// Looks a point up in the side grid. Finds nothing beyond a wall of the region, nor in a model
/// that is not watertight, which has no mask. Accepts any point of the model frame.
///
/// frames  for prefetching the mask record that a search reads next
inline octree::SideGrid::Lookup look_up_side_grid(const ModelGeometry& model,
                                                  const octree::Point& point,
                                                  const octree::FrameTable& frames) noexcept {
  const bool known = !model.region.has_walls() || model.region.holds(point);
  const auto ahead = [&](const octree::SideGridRecord& record) {
    octree::MaskRecords::prefetch(model.mask, record.link, frames);
  };
  return known ? model.side_grid.look(point, ahead) : octree::SideGrid::Lookup{};
}

/// Returns what find_side() would, if that takes no page: beyond a wall of a region, in a region of
/// a model that is not watertight, outside of a watertight model's box, or where the side grid has
/// the side. Else returns nothing. Accepts any point of the model frame.
///
/// lookup  result of look_up_side_grid() for the point
std::optional<SideResult> side_without_pages(const ModelGeometry& model, const octree::Point& point,
                                             const octree::SideGrid::Lookup& lookup) noexcept;

/// Returns whether the point is certainly on the side of the last point in `cache`. If so, the
/// point becomes the last point, and cache.side_result() is its result.
///
/// clear  lower bound on the distance of the point from the surface, model frame
bool is_cached_side(const ModelGeometry& model, const octree::Point& point, double clear,
                    SideCache& cache) noexcept;

/// Does what find_side() above does with the help of `cache`, and stores an exact result there. If
/// work is limited or pages are missing, the result depends on earlier queries.
///
/// lookup  result of look_up_side_grid() for the point
/// clear   lower bound on the distance of the point from the surface, model frame; may be 0
SideResult find_side(const ModelGeometry& model, const octree::Point& point,
                     const octree::SideGrid::Lookup& lookup, double clear, SideCache& cache,
                     std::uint64_t max_work, const octree::PageReader& pages,
                     octree::TraversalStats& work) noexcept;

}  // namespace planetree::query
