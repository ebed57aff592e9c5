#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "octree/mask/mask_lookup.h"
#include "planetree/types.h"

namespace planetree::query {

/// The side of a point with respect to a model's surface.
struct SideResult {
  Side side = Side::kUnknown;
  Status status = Status::kExact;  ///< kDegraded: pages were missing or the work was spent
  /// Watertight models: a number with the sign of the point's winding number, or 0 if that is 0.
  /// Other models: the winding number, rounded to a whole number; 0 if the side is unknown.
  /// For a point on the surface see `beside`.
  std::int64_t winding = 0;
  /// Meaning of `winding` for a point on the surface. True: it is that of the perturbed point.
  /// False (models that are not watertight): it is the sign of the winding number of the surface
  /// without the triangles that the point is on, or 0 if that sign is uncertain.
  bool beside = true;
};

/// The last side and the last mask cell that a probe's queries found, for the next queries nearby.
/// For watertight models only, since in others winding numbers are not constant off the surface. It
/// allocates nothing. One thread at a time may use it. All lengths are in the model frame.
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
    const double diagonal2 = (tree.box_upper - tree.box_lower).squaredNorm();
    return (point - point_).squaredNorm() < diagonal2 * (kNear * kNear);
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
    return gap * (1 + kRounding) < radius;
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
  static constexpr double kNear = 0x1p-6;       // share of the model's diagonal
  static constexpr double kRounding = 0x1p-40;  // exceeds the relative error of `gap`

  octree::MaskLookup cell_;
  octree::Point cell_lower_ = octree::Point::Constant(kNowhere);
  octree::Point cell_upper_ = octree::Point::Constant(kNowhere);
  octree::Point point_ = octree::Point::Constant(kNowhere);
  SideResult side_result_;
  bool has_exact_winding_ = false;
  double clear_ = 0;  // lower bound on the distance of point_ from the surface
};

}  // namespace planetree::query
