#pragma once

#include <cstdint>

#include "octree/nearest/front_side.h"
#include "octree/nearest/nearest.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

class WorkLimit;

/// Computes the unit normal of a triangle, along (b - a) x (c - a).
///
/// triangle  model frame.
/// unit      the normal, right within 2^-26 rad down to a sine of 2^-84 of the angle at a; left
///           as it is if the triangle has no area.
/// area2     square of twice the area.
/// limit     charged for what double does not suffice for; may be null.
/// return    false if the triangle has no area, or if the limit refuses.
///
/// Error. A cross product errs by 5 roundings over the sine of the angle between the edges. Double
/// is used down to a sine of 2^-24, so that the error is below 2^-26 rad. Thinner triangles are
/// evaluated with 113 bits, so that it is below 2^-26 rad down to a sine of 2^-84.
bool face_normal(const Triangle& triangle, Point& unit, double& area2,
                 WorkLimit* limit = nullptr) noexcept;

/// A pseudo-normal. Its sign follows the orientation of the mesh.
struct FeatureNormal {
  /// Length 1, or zero if no face at the feature has area.
  Point normal = Point::Zero();
  /// False: pages were missing or `max_work` was spent. The normal is that of the faces found.
  bool complete = true;
  /// FacingSides::common() if all faces were found and the nearest triangle's block is in a height
  /// field; else 0.
  int side = 0;
  /// Side of the pseudo-normal that the query is on, if requested; never kOnSurface.
  Front front = Front::kUnknown;
};

/// Computes the pseudo-normal at a nearest point: the normal of the face, the sum of the normals
/// of the faces at an edge, or that sum at a vertex, weighted by the faces' angles there. Faces
/// share an edge or a vertex if the coordinates are equal. Where the sum is zero up to rounding,
/// the result is the normal of the face of least index that has area.
///
/// query, nearest   a query and its answer, which names a triangle; model frame.
/// coherence_cache  as that query left it; may be null. If it has all faces at the nearest point,
///                  no page is read. If it has only the subtrees that they are in, no other
///                  subtree is visited, unless the faces are more than can be sorted.
/// max_work         maximum work in units, see WorkLimit.
/// work             counters that the search adds to.
/// found            receives the result, because returning a copy takes longer.
/// front_side       finds FeatureNormal::front; null: not requested.
/// threads          any; no allocation, no lock, no exception of its own.
/// source           Baerentzen & Aanaes 2005, "Signed distance computation using the angle
///                  weighted pseudonormal".
void feature_normal(const TreeInfo& tree, const Point& query, const NearestAnswer& nearest,
                    const CoherenceCache* coherence_cache, std::uint64_t max_work,
                    const PageReader& pages, TraversalStats& work, FeatureNormal& found,
                    FrontSide* front_side = nullptr) noexcept;

}  // namespace planetree::octree
