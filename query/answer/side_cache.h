#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "octree/mask/mask_lookup.h"
#include "planetree/types.h"

namespace planetree::query {

/// Where a point stands with respect to a model's surface.
struct SideResult {
  Side side = Side::kUnknown;
  Status status = Status::kExact;  ///< kDegraded: pages missing or the work spent
  /// Of watertight models as much as 0, and of the sign of, the winding number of
  /// the point; else that to the nearest whole number where the side is known. On
  /// the surface: of a step beside the point if `beside`, else 1 or -1 as the rest
  /// of the surface winds about it, 0 where that is too little to tell.
  std::int64_t winding = 0;
  bool beside = true;
};

/// What a probe's last asks found out about sides, for the next ones nearby. Of watertight
/// models alone: elsewhere winding numbers are not constant off the surface. Plain memory,
/// one thread.
class SideCache {
 public:
  /// The cell of the mask that the point is in, if it is the last one; else null.
  const octree::MaskLookup* cell_with(const octree::Point& point) const {
    const bool within =
        (point.array() >= cell_lower_.array()).all() && (point.array() < cell_upper_.array()).all();
    return within ? &cell_ : nullptr;
  }
  /// Whether asks come from about the same place, so that a cell is worth its bounds.
  bool is_near(const octree::Point& point, const octree::TreeInfo& tree) const {
    const double diagonal2 = (tree.box_upper - tree.box_lower).squaredNorm();
    return (point - point_).squaredNorm() < diagonal2 * (kNear * kNear);
  }
  void note_cell(const octree::MaskInfo& mask, const octree::MaskLookup& found) {
    const octree::CellGrid grid(mask.lower);
    cell_ = found;
    cell_lower_ = grid.lower(found.cell);
    cell_upper_ = grid.upper(found.cell);
  }

  /// The last point whose side was found.
  const octree::Point& point() const { return point_; }
  /// Its side; unknown before any was found.
  const SideResult& side_result() const { return side_result_; }
  /// Whether its winding number is right, and not of the right sign alone.
  bool has_exact_winding() const { return has_exact_winding_; }

  /// Whether `point`, which has no surface nearer than `clear`, stands where the last one
  /// does: there is nothing between.
  bool same_side(const octree::Point& point, double clear) const {
    const double radius = std::max(clear, clear_);
    if (!(radius > 0)) return false;
    const double gap = (point - point_).norm();
    return gap * (1 + kRounding) < radius;
  }

  /// A point's side; no surface is nearer to it than `clear`, which may be 0.
  void note(const octree::Point& point, const SideResult& side_result, bool has_exact_winding,
            double clear) {
    side_result_ = side_result;
    has_exact_winding_ = has_exact_winding;
    move_to(point, clear);
  }
  /// The same of a point that stands where the last one does.
  void move_to(const octree::Point& point, double clear) {
    const bool off_surface =
        side_result_.side == Side::kInside || side_result_.side == Side::kOutside;
    point_ = point;
    clear_ = off_surface ? clear : 0;
  }

 private:
  static constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  static constexpr double kNear = 0x1p-6;  ///< as a share of the model's diagonal
  static constexpr double kRounding = 0x1p-40;

  octree::MaskLookup cell_;
  octree::Point cell_lower_ = octree::Point::Constant(kNowhere);
  octree::Point cell_upper_ = octree::Point::Constant(kNowhere);
  octree::Point point_ = octree::Point::Constant(kNowhere);
  SideResult side_result_;
  bool has_exact_winding_ = false;
  double clear_ = 0;
};

}  // namespace planetree::query
