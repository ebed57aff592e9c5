#pragma once

#include <cmath>
#include <cstdint>

#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// Part of a winding number that is known before the triangles of a tree are summed up.
struct WindingBase {
  double value = 0;
  double error = 0;
};

/// What is to be found out of a winding number.
enum class WindingGoal : std::uint8_t {
  kHalf,  ///< whether its magnitude is above one half
  kSign,  ///< its sign, or that its magnitude is below 1/4
};

/// A winding number and its error bound.
struct WindingNumber {
  double value = 0;
  /// Maximum distance of the true winding number from `value`; infinite if nothing is known.
  double error = 0;
  /// The point is on a triangle of the tree. `value` leaves out those that the point is on.
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

/// Computes a generalised winding number until the goal is reached: the sum of `base` and of the
/// shares of a tree's triangles. Children are opened in the order of the error that their moments
/// leave, greatest first, so that few are opened. A child that is opened down to its triangles
/// leaves an error of about 2^-45 a triangle.
///
/// tree      of caps: its nodes have moments, or it is a single block.
/// point     model frame, no coordinate beyond kMaxQueryCoordinate.
/// max_work  maximum work in units, see WorkLimit.
/// work      counters that the sum adds to.
/// return    decided, if complete. A missing page is replaced by the moments of the child that
///           leads to it.
/// threads   any; no allocation, no lock, no exception of its own.
/// source    Jacobson et al. 2013, "Robust inside-outside segmentation using generalized winding
///           numbers"; Barill et al. 2018, "Fast winding numbers for soups and clouds". The error
///           bounds and the order of opening are planetree's own.
WindingNumber winding_number(const TreeInfo& tree, const Point& point, std::uint64_t max_work,
                             const PageReader& pages, TraversalStats& work,
                             const WindingBase& base = {},
                             WindingGoal goal = WindingGoal::kHalf) noexcept;

}  // namespace planetree::octree
