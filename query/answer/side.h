#pragma once

#include <cstdint>
#include <optional>

#include "octree/geometry/cell_grid.h"
#include "octree/mask/mask_records.h"
#include "octree/traversal/tree_view.h"
#include "planetree/types.h"
#include "query/answer/model_geometry.h"
#include "query/answer/side_cache.h"

namespace planetree::query {

/// How a side was found: for those who ask why.
struct SideReason {
  enum class Rule : std::uint8_t {
    kNone,           ///< the side is not known
    kRegion,         ///< nor can it be: the file is of a region, and the point beyond it or the
                     ///< model not watertight
    kOutsideBox,     ///< of the model
    kColour,         ///< `cell` is white or black
    kPlanes,         ///< `cell` is special
    kSlab,           ///< the surface in `cell` is between two planes, the point beyond one of them
    kCorner,         ///< `crossings` from a corner of `cell`, `end`, where `known` is known
    kWayOut,         ///< `crossings` from `end`, outside of the model's box, or of its region's
                     ///< least corner
    kWindingNumber,  ///< of a model that is not watertight: `value`, right within `error`
  };
  Rule rule = Rule::kNone;
  octree::GridCell cell;  ///< of the mask: the smallest that was reached
  bool in_mask = false;   ///< whether there is one, so that `cell` says something
  octree::Point end = octree::Point::Zero();
  std::int64_t known = 0;      ///< winding number at `end`
  std::int64_t crossings = 0;  ///< what it changes by from there to the point
  double value = 0;
  double error = 0;
};

/// Which side of a model's surface a point is on.
///
/// point      model frame.
/// max_work  most nodes and blocks to visit.
/// reason     filled if not null.
/// return     kUnknown where degraded, and where the winding number of a model
///            that is not watertight is one half to rounding.
SideResult find_side(const ModelGeometry& model, const octree::Point& point, std::uint64_t max_work,
                     const octree::PageReader& pages, octree::TraversalStats& work,
                     SideReason* reason = nullptr) noexcept;

/// What octree::SideGrid knows of a point, as far as the file knows it. The point may be any.
/// Models that are not watertight have no colours.
inline octree::SideGrid::Lookup look_up_side_grid(const ModelGeometry& model,
                                                  const octree::Point& point,
                                                  const octree::FrameTable& frames) noexcept {
  const bool known = !model.region.has_walls() || model.region.holds(point);
  const auto ahead = [&](const octree::SideGridRecord& record) {
    octree::MaskRecords::prefetch(model.mask, record.link, frames);
  };
  return known ? model.side_grid.look(point, ahead) : octree::SideGrid::Lookup{};
}

/// The same as find_side() where one look tells: beyond a wall of a region, outside of a
/// watertight model's box, or in a white or black cell. The point may be any.
std::optional<SideResult> side_without_pages(const ModelGeometry& model, const octree::Point& point,
                                             const octree::SideGrid::Lookup& lookup) noexcept;

/// Whether the point cannot but stand where the last one that `cache` knows does, which then is
/// what it knows of this one. No surface is nearer to the point than `clear`.
bool is_cached_side(const ModelGeometry& model, const octree::Point& point, double clear,
                    SideCache& cache) noexcept;

/// The same by way of what `cache` knows if that is nearer, and hints there: where work is
/// limited, or pages are missing, what is told depends on the asks before. No surface is nearer
/// to the point than `clear`, which may be 0.
/// spot  what look_up_side_grid() says.
SideResult find_side(const ModelGeometry& model, const octree::Point& point,
                     const octree::SideGrid::Lookup& lookup, double clear, SideCache& cache,
                     std::uint64_t max_work, const octree::PageReader& pages,
                     octree::TraversalStats& work) noexcept;

}  // namespace planetree::query
