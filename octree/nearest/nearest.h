#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "octree/field/coarse_field.h"
#include "octree/geometry/tree_limits.h"
#include "octree/geometry/triangle_distance.h"
#include "octree/nearest/coherence_cache.h"
#include "octree/traversal/tree_view.h"
#include "planetree/types.h"

namespace planetree::octree {

/// An answer in the model frame: the nearest point of one triangle, and the interval that holds
/// the distance to the nearest of all.
struct NearestAnswer : NearestOnTriangle {
  double distance = 0;
  double lower = 0;
  double upper = 0;
  std::uint64_t triangle = kNoTriangle;
  Triangle corners{Point::Zero(), Point::Zero(), Point::Zero()};  ///< corners of `triangle`
  bool is_height_field = false;  ///< its block is known to be in a height field (BlockHeader)
  Status status = Status::kBadQuery;
};

/// Limits of one traversal. Lengths are in the model frame.
struct NearestLimits {
  double max_error = 0;
  double max_distance = std::numeric_limits<double>::infinity();
  std::uint32_t max_work = std::numeric_limits<std::uint32_t>::max();
  /// Earlier answer with a triangle of this tree, or null. Where pages are missing, the triangle
  /// is evaluated again; its old distance is not used. If set, queries of limited work use the
  /// coherence cache too, so that answers that are not exact depend on earlier queries.
  const NearestAnswer* known = nullptr;
  /// Whether a query that the field cannot answer is to be answered exactly, because the last one
  /// is so near that the coherence cache makes that cheaper than an answer within the error. The
  /// answer then depends on earlier queries.
  bool prefers_exact = false;
  /// Coarse field of the tree, or null. It bounds the distance before any page is read, narrows
  /// answers that are not exact, and gives answers within an error of its own.
  const CoarseField* field = nullptr;
  /// Maximum width of the interval of an answer that is the field's alone, as a share of its lower
  /// end. Such an answer has no triangle.
  double max_field_share = std::numeric_limits<double>::infinity();
  /// Upper bound on the distance, where the caller has looked at the field.
  double within = std::numeric_limits<double>::infinity();

  /// Whether the answer is the same for every order of visits. With limited work or an allowed
  /// error it depends on that order. The order must then not depend on which pages are resident,
  /// and may depend on earlier queries only if `known` is set.
  bool allow_any_way() const { return max_error == 0 && has_unlimited_work(); }
  /// Whether the order of visits may depend on which pages are resident.
  bool may_depend_on_pages() const { return known || allow_any_way(); }
  /// Whether the work may be spent before any triangle is found.
  bool has_little_work() const { return max_work <= 1024; }
  /// Whether the coarse field is likely to answer where it has this estimate.
  bool may_be_answered_by(const CoarseField::Estimate& estimate) const {
    return estimate.width <= max_error &&
           (!needs_triangle() || estimate.width <= max_field_share * estimate.lower);
  }
  /// Whether an answer within an error must have a triangle wherever the field does not answer it.
  bool needs_triangle() const { return max_field_share < std::numeric_limits<double>::infinity(); }
  bool has_unlimited_work() const { return max_work == std::numeric_limits<std::uint32_t>::max(); }
};

/// Finds the surface point nearest to `query` by a traversal of the tree, nearest child first. Near
/// the surface it continues with the nearest child of the last node. Far from it, it takes the two
/// nearest children of all visited nodes at a time. If the ball of `coherence_cache` holds
/// everything that may be nearest, it starts at the ball's subtrees instead of the root.
///
/// query            model frame, no coordinate beyond kMaxQueryCoordinate.
/// work             counters that the traversal adds to.
/// coherence_cache  read and renewed; may be null.
/// return           the triangle of least (value, index). The value is that of
///                  octree/geometry/triangle_distance.h, so that an exact answer is a function of
///                  tree and query alone. [lower, upper] holds the true distance for every status.
///                  A missing page counts as a leaf with a lower bound: the traversal goes on
///                  elsewhere, and the answer is still kExact if no missing page can matter.
/// threads          any; no allocation, no lock, no exception of its own.
/// source           traversal and float filter are planetree's own; octree/traversal/bounds.h
///                  derives the bounds.
NearestAnswer nearest(const TreeInfo& tree, const Point& query, const NearestLimits& limits,
                      const PageReader& pages, TraversalStats& work,
                      CoherenceCache* coherence_cache = nullptr) noexcept;

}  // namespace planetree::octree
