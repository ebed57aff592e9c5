#pragma once

#include <cmath>
#include <cstdint>

#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// A winding number and its error bound.
struct WindingNumber {
  double value = 0;
  /// Maximum distance of the true winding number from `value`; infinite if nothing is known.
  double error = 0;
  /// The point is on a triangle. `value` leaves out the triangles that the point is on.
  bool on_surface = false;
  /// False: pages were missing or `max_work` was spent before the result was decided.
  bool complete = true;

  /// Whether the magnitude is certainly above one half.
  bool above_half() const { return value - error > 0.5 || value + error < -0.5; }
  /// Whether the magnitude is certainly below one half.
  bool below_half() const { return value + error < 0.5 && value - error > -0.5; }
  /// Whether the sign of the value is certain.
  bool sign_is_certain() const { return std::fabs(value) > error; }
};

/// Computes the generalised winding number of a point until it is certain whether its magnitude is
/// above one half. Children are opened in the order of the error that their moments leave, greatest
/// first, so that few are opened. A child that is opened down to its triangles leaves an error of
/// about 2^-45 a triangle.
///
/// tree      its nodes have moments, or it is a single block.
/// point     model frame, no coordinate beyond kMaxQueryCoordinate.
/// max_work  maximum work in units, see WorkLimit.
/// work      counters that the sum adds to.
/// return    decided, if complete. For a point on the surface it is enough to know the sign, or
///           that the magnitude is below 1/4. A missing page is replaced by the moments of the
///           child that leads to it.
/// threads   any; no allocation, no lock, no exception of its own.
/// source    Jacobson et al. 2013, "Robust inside-outside segmentation using generalized winding
///           numbers"; Barill et al. 2018, "Fast winding numbers for soups and clouds". The error
///           bounds and the order of opening are planetree's own.
WindingNumber winding_number(const TreeInfo& tree, const Point& point, std::uint64_t max_work,
                             const PageReader& pages, TraversalStats& work) noexcept;

}  // namespace planetree::octree
