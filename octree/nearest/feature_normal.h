#pragma once

#include <cstdint>

#include "octree/nearest/nearest.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// The unit normal of a triangle, (b - a) x (c - a), and, squared, twice its area; false if it
/// has none, and `unit` is then left as it is.
/// A cross product errs by 5 roundings over the sine of the edges' angle: in
/// double down to a sine of 2^-24, so by less than 2^-26 rad, and with 113 bits
/// below that, so by less than 2^-26 rad down to a sine of 2^-84.
bool face_normal(const Triangle& triangle, Point& unit, double& area2) noexcept;

/// A pseudo-normal, as the mesh is oriented.
struct FeatureNormal {
  /// Of length 1; zero where no face at the feature has an area.
  Point normal = Point::Zero();
  bool complete = true;  ///< false: pages missing or `max_work` spent; of what was found
  int side = 0;  ///< FacingSides::common(), where all faces were found and one is in a sheet
};

/// The normal at a nearest point: that of the face, the sum over the faces of
/// an edge, or the sum over the faces of a vertex weighted by their angles
/// there. Faces share an edge or a vertex where its ends are equal. Where the
/// sum is zero, to rounding, it is that of the first face that has an area.
///
/// query, nearest  of one answer, that names a triangle.
/// vicinity   of that answer; where it has all faces there no page is looked at, and where it has
///            the subtrees that they are in no other. May be null.
/// max_work  most nodes and blocks to visit.
/// found      what it is; written where it is wanted, for to copy it takes longer.
/// threads    any; no allocation, no lock, no exception of its own.
/// source     Baerentzen & Aanaes 2005, "Signed distance computation using the
///            angle weighted pseudonormal".
void feature_normal(const TreeInfo& tree, const Point& query, const NearestAnswer& nearest,
                    const CoherenceCache* coherence_cache, std::uint64_t max_work,
                    const PageReader& pages, TraversalStats& work, FeatureNormal& found) noexcept;

}  // namespace planetree::octree
