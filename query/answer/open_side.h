#pragma once

#include <cstdint>

#include "octree/traversal/tree_view.h"
#include "octree/winding/winding_number.h"
#include "query/answer/model_geometry.h"
#include "query/answer/side.h"
#include "query/answer/side_search.h"

namespace planetree::query {

/// Finds the side of a point of a surface with caps from the winding number of the surface and its
/// caps, which is whole. What the caps add to it is taken away. Where the cap grid is clear the
/// caps' share is too small to matter.
class OpenSide {
 public:
  /// The arguments must outlive this.
  ///
  /// search  finds the winding number with the caps; null for a point outside of the model's box,
  ///         where it is 0.
  /// reason  may be null.
  OpenSide(const ModelGeometry& model, const octree::Point& point, std::uint64_t max_work,
           const octree::PageReader& pages, octree::TraversalStats& work, SideReason* reason,
           SideSearch* search)
      : model_(model),
        point_(point),
        pages_(pages),
        work_(work),
        reason_(reason),
        search_(search),
        limit_(work.units, max_work) {}

  /// closed  side with respect to the surface and its caps.
  SideResult run(const SideResult& closed);
  /// Finds the sign of the winding number of the surface without the triangles that the point is
  /// on. The surface may be watertight.
  ///
  /// on_surface  the side of the point, found by run() or by a SideSearch.
  SideResult sign_on_surface(const SideResult& on_surface);

 private:
  octree::WindingNumber beside_triangles(std::int64_t closed, octree::WindingGoal goal);
  SideResult result_of(const octree::WindingNumber& w, double closed) const;
  octree::WindingNumber less_caps(const octree::WindingBase& base, octree::WindingGoal goal);

  const ModelGeometry& model_;
  const octree::Point& point_;
  const octree::PageReader& pages_;
  octree::TraversalStats& work_;
  SideReason* const reason_;
  SideSearch* const search_;
  octree::WorkLimit limit_;
};

}  // namespace planetree::query
