#pragma once

#include <cstdint>

#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// The share of a winding number that the triangles and caps at a point have.
struct StarShare {
  double value = 0;
  double error = 0;      ///< |value - true share| is at most this
  bool complete = true;  ///< false: pages missing or `max_work` spent; nothing is known
};

/// Sums the shares of the triangles of the surface and of the caps that a point is on, as seen from
/// the point after its infinitesimal step (see PerturbedSegment). Only the sum is known: the share
/// of a triangle at an edge or a corner depends on the direction of the step.
///
/// tree      of the surface, with its caps.
/// point     model frame.
/// max_work  maximum work in units, see WorkLimit.
/// work      counters that the sum adds to.
/// threads   any; no allocation, no lock, no exception.
///
/// Method. Let b be a point that is in the plane of no triangle T of the sum. With b, T spans a
/// tetrahedron, and each edge of T a triangle. The share of T is 1 or -1 if the moved point is in
/// the tetrahedron, less the shares of the tetrahedron's other sides. The surface and its caps are
/// closed, so that sides along edges that the point is on cancel each other. The point is on none
/// of the others, where shares are certain.
StarShare star_share(const TreeInfo& tree, const Point& point, std::uint64_t max_work,
                     const PageReader& pages, TraversalStats& work) noexcept;

}  // namespace planetree::octree
