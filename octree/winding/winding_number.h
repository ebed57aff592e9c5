#pragma once

#include <cstdint>

#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// A winding number and how far it may be off.
struct WindingNumber {
  double value = 0;
  double error = 0;  ///< the true one is within this of `value`; infinite if nothing is known
  bool on_surface = false;  ///< the point is on a triangle; such have no part in `value`
  bool complete = true;     ///< false: pages missing or `max_work` spent before it was decided

  /// |w| is certainly more, or less, than one half.
  bool above_half() const { return value - error > 0.5 || value + error < -0.5; }
  bool below_half() const { return value + error < 0.5 && value - error > -0.5; }
};

/// The generalised winding number of a point, as far as it takes to tell
/// whether its magnitude is more than one half. Children are opened in the
/// order of what their moments leave open, so that few are; one that is opened
/// down to its triangles leaves open some 2^-45 a triangle.
///
/// tree       of nodes with moments, or a single block.
/// point      model frame, no coordinate beyond kFarthestQuery.
/// max_work  most nodes and blocks to visit.
/// return     on the surface it is enough to know the sign, or that the
///            magnitude is below 1/4. A page that cannot be had is left to the
///            moments of the child that leads to it.
/// threads    any; no allocation, no lock, no exception of its own.
/// source     Jacobson et al. 2013, "Robust inside-outside segmentation using
///            generalized winding numbers"; Barill et al. 2018, "Fast winding
///            numbers for soups and clouds". Certain intervals and the order of
///            opening are ours.
WindingNumber winding_number(const TreeInfo& tree, const Point& point, std::uint64_t max_work,
                             const PageReader& pages, TraversalStats& work) noexcept;

}  // namespace planetree::octree
