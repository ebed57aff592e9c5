#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "octree/geometry/cell_grid.h"
#include "octree/geometry/error_bounds.h"
#include "octree/geometry/work_limit.h"
#include "octree/mask/mask_lookup.h"
#include "octree/mask/side_grid.h"
#include "octree/nearest/feature_normal.h"
#include "octree/nearest/nearest.h"
#include "octree/traversal/tree_view.h"
#include "planetree/types.h"
#include "query/answer/model_geometry.h"

namespace planetree::query {

struct QueryContext;

/// The side of a point with respect to a model's surface.
struct SideResult {
  Side side = Side::kUnknown;
  Status status = Status::kExact;  ///< kDegraded: pages were missing or the work was spent
  /// A number with the sign of the point's winding number, or 0 if that is 0. Where caps matter:
  /// the winding number, rounded to a whole number if the point is inside, else 0. For a point on
  /// the surface see `beside`.
  std::int64_t winding = 0;
  /// Meaning of `winding` for a point on the surface. True: it is that of the perturbed point.
  /// False (a result of side_for_normal()): it is the sign of the winding number of the surface
  /// without the triangles that the point is on, or 0 if that sign is uncertain.
  bool beside = true;
  /// False for a point on the surface if pages were missing, or the work was spent, before the sign
  /// in `winding` was certain. The side is proven all the same.
  bool winding_is_known = true;
};

/// The last side and the last mask cell that a probe's queries found, for the next queries nearby.
/// Of a surface with caps, it holds points that the caps cannot matter to. It allocates nothing.
/// One thread at a time may use it. All lengths are in the model frame.
class SideCache {
 public:
  /// Returns the cached lookup if the point is in its mask cell, else null.
  const octree::MaskLookup* cell_with(const octree::Point& point) const {
    const bool within =
        (point.array() >= cell_lower_.array()).all() && (point.array() < cell_upper_.array()).all();
    return within ? &cell_ : nullptr;
  }
  /// Returns whether a point is near the last one. Only then does caching a cell repay computing
  /// the cell's bounds.
  bool is_near(const octree::Point& point, const octree::TreeInfo& tree) const {
    const double diagonal2 = (tree.core_upper - tree.core_lower).squaredNorm();
    return (point - point_).squaredNorm() < diagonal2 * (kMaxSideStepShare * kMaxSideStepShare);
  }
  /// Stores the lookup of a mask cell that holds for all points in the cell.
  void note_cell(const octree::MaskInfo& mask, const octree::MaskLookup& found) {
    const octree::CellGrid grid(mask.lower);
    cell_ = found;
    cell_lower_ = grid.lower(found.cell);
    cell_upper_ = grid.upper(found.cell);
  }

  /// Last point whose side was found; NaN before the first.
  const octree::Point& point() const { return point_; }
  /// Side of point(); unknown before the first.
  const SideResult& side_result() const { return side_result_; }
  /// Whether side_result().winding is exactly the winding number. If not, only its sign is right.
  bool has_exact_winding() const { return has_exact_winding_; }

  /// Returns whether a point is certainly on the side of the last one, because no surface lies
  /// between them. `clear` is a lower bound on the point's distance from the surface.
  bool same_side(const octree::Point& point, double clear) const {
    const double radius = std::max(clear, clear_);
    if (!(radius > 0)) return false;
    const double gap = (point - point_).norm();
    return gap * (1 + octree::kGapRounding) < radius;
  }

  /// Stores the side of a point. `clear` is a lower bound on its distance from the
  /// surface and may be 0.
  void note(const octree::Point& point, const SideResult& side_result, bool has_exact_winding,
            double clear) {
    side_result_ = side_result;
    has_exact_winding_ = has_exact_winding;
    move_to(point, clear);
  }
  /// Makes a point on the side of the last one the last point.
  void move_to(const octree::Point& point, double clear) {
    const bool off_surface =
        side_result_.side == Side::kInside || side_result_.side == Side::kOutside;
    point_ = point;
    clear_ = off_surface ? clear : 0;
  }

 private:
  static constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  static constexpr double kMaxSideStepShare = 0x1p-6;  // share of the core's diagonal

  octree::MaskLookup cell_;
  octree::Point cell_lower_ = octree::Point::Constant(kNowhere);
  octree::Point cell_upper_ = octree::Point::Constant(kNowhere);
  octree::Point point_ = octree::Point::Constant(kNowhere);
  SideResult side_result_;
  bool has_exact_winding_ = false;
  double clear_ = 0;  // lower bound on the distance of point_ from the surface
};

/// How a side was found, for reports.
struct SideReason {
  enum class Rule : std::uint8_t {
    kNone,           ///< the side is unknown
    kRegion,         ///< the side cannot be known: the point is beyond a wall of the file's region
    kOutsideBox,     ///< the point is outside of the model's box
    kColour,         ///< `cell` is white, black or inverted
    kPlanes,         ///< `cell` is special
    kSlab,           ///< the point is beyond a plane of the slab of `cell`
    kCorner,         ///< `crossings` to `end`, a corner of `cell`
    kWayOut,         ///< `crossings` to `end`, which is outside of the model's box or is
                     ///< ModelGeometry::region_corner
    kWindingNumber,  ///< `value`, right within `error`: `closed` less the share of the caps
    kFront,          ///< the model is a sheet: in front of the nearest feature, or behind it
  };
  Rule rule = Rule::kNone;
  octree::GridCell cell;  ///< the smallest cell of the mask that was reached
  bool in_mask = false;   ///< the model has a mask, so that `cell` has a meaning
  octree::Point end = octree::Point::Zero();  ///< model frame
  std::int64_t known = 0;                     ///< winding number at `end`
  std::int64_t crossings = 0;                 ///< its change from `end` to the point
  bool caps_cannot_matter = false;            ///< there are caps, too far away to change the side
  double closed = 0;                          ///< winding number with the caps
  double value = 0;                           ///< winding number of the point
  double error = 0;                           ///< error bound of `value`
};

/// Finds the side of a model's surface that a point is on.
///
/// point     model frame
/// max_work  maximum work in units, see octree::WorkLimit
/// work      counters that the search adds to
/// reason    receives how the side was found; may be null
/// return    kUnknown, and degraded, if pages were missing, the work was spent, the side cannot be
///           known (Rule::kRegion), or the winding number is one half up to rounding
SideResult find_side(const ModelGeometry& model, const octree::Point& point, std::uint64_t max_work,
                     const octree::PageReader& pages, octree::TraversalStats& work,
                     SideReason* reason = nullptr) noexcept;

/// Looks a point up in the side grid. Finds nothing beyond a wall of the region. Accepts any point
/// of the model frame.
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

/// Returns what find_side() would, if that takes no page: beyond a wall of a region, outside of a
/// watertight model's box, or where the side grid has the side. Else returns nothing. Accepts any
/// point of the model frame.
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

/// Finds the side of a point that the side grid does not decide.
///
/// query    model units; is_valid() holds
/// scaled   the query in the model frame
/// lookup   result of look_up_side_grid() for `scaled`
/// options  returned by with_defaults()
SideResult find_containment(const QueryContext& context, const Vec3& query,
                            const octree::Point& scaled, const octree::SideGrid::Lookup& lookup,
                            const QueryOptions& options) noexcept;

/// Finds what contact_normal() needs of a point on the surface that find_side() leaves open: the
/// sign of the winding number without the triangles at the point. Where faces, or the winding
/// number of the perturbed point, tell the orientation, it returns the side unchanged.
///
/// on_surface  the side of the point
/// feature     nearest feature of the surface, at the point
SideResult side_for_normal(const ModelGeometry& model, const octree::Point& point,
                           const SideResult& on_surface, Feature feature, std::uint64_t max_work,
                           const octree::PageReader& pages, octree::TraversalStats& work) noexcept;

/// Returns the unit normal at a nearest point. It points out of the solid; if the side is unknown,
/// it follows the orientation of the mesh. It is (0, 0, 1) if no face at the feature has area.
///
/// query, nearest  a query and its answer, which names a triangle; model frame
/// feature         pseudo-normal at the nearest point
/// side_result     side of the query
/// limit           charged for signs that double does not suffice for. If it refuses, the normal
///                 follows the orientation of the mesh.
octree::Point contact_normal(const octree::Point& query, const octree::NearestAnswer& nearest,
                             const octree::FeatureNormal& feature, const SideResult& side_result,
                             octree::WorkLimit& limit) noexcept;

}  // namespace planetree::query
