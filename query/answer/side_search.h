#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "octree/mask/mask_lookup.h"
#include "octree/mask/side_grid.h"
#include "octree/traversal/tree_view.h"
#include "octree/winding/crossings.h"
#include "query/answer/model_geometry.h"
#include "query/answer/side.h"

namespace planetree::query {

/// Returns whether a point of the model frame is strictly outside of a model's box.
inline bool outside_box(const octree::TreeInfo& tree, const octree::Point& point) {
  return (point.array() < tree.box_lower.array()).any() ||
         (point.array() > tree.box_upper.array()).any();
}

/// The six segments along the axes from a point to just outside of a model's box, shortest first.
class ExitSegments {
 public:
  struct Segment {
    double length = 0;
    octree::Point end = octree::Point::Zero();  ///< strictly outside; winding number 0
  };

  /// from  start of all segments: a point in the box, model frame
  ExitSegments(const octree::TreeInfo& tree, const octree::Point& from) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      add(from, axis, tree.box_lower[axis], -1);
      add(from, axis, tree.box_upper[axis], 1);
    }
  }

  const std::array<Segment, 6>& all() const { return segments_; }

 private:
  void add(const octree::Point& from, Eigen::Index axis, double side, double direction) {
    Segment segment{std::fabs(side - from[axis]), from};
    // Adding 1 to a coordinate far from the origin may not change it.
    const double infinity = std::numeric_limits<double>::infinity();
    const double beyond = std::nextafter(side, direction * infinity);
    segment.end[axis] = direction < 0 ? std::min(side - 1, beyond) : std::max(side + 1, beyond);
    // Inserts the segment behind those of the same length.
    std::size_t at = count_++;
    for (; at > 0 && segment.length < segments_[at - 1].length; --at)
      segments_[at] = segments_[at - 1];
    segments_[at] = segment;
  }

  std::size_t count_ = 0;
  std::array<Segment, 6> segments_;
};

/// Results of earlier work that a search may use. Null: the search must not depend on it.
struct SideHints {
  SideCache* cache = nullptr;                        ///< sides and cells of earlier queries
  const octree::SideGrid::Lookup* lookup = nullptr;  ///< result of look_up_side_grid()
};

/// Finds the side of one point with respect to the surface and its caps. The point is in the
/// model's box and in its region. Where the mask alone does not tell, the search counts the
/// crossings of a segment from the point to an end of known winding number.
class SideSearch {
 public:
  /// The arguments must outlive this; `reason` may be null.
  SideSearch(const ModelGeometry& model, const octree::Point& point, std::uint64_t max_work,
             const octree::PageReader& pages, octree::TraversalStats& work, SideReason* reason,
             const SideHints& hints = {})
      : model_(model),
        point_(point),
        max_work_(max_work),
        pages_(pages),
        work_(work),
        reason_(reason),
        cache_(hints.cache),
        lookup_(hints.lookup),
        work_before_(work.units) {}

  /// Runs the search, once. kDegraded if pages were missing or the work was spent.
  SideResult run();

  /// Counts crossings out of the model, for a point whose winding number is known but for its size.
  /// The number of the result is exact. Unknown if pages were missing or the work was spent.
  SideResult count_exactly(std::uint64_t max_work);

  std::uint64_t work_left() const {
    const std::uint64_t spent = work_.units - work_before_;
    return spent < max_work_ ? max_work_ - spent : 0;
  }
  /// Whether the winding number of the result is exact. If not, only its sign is right.
  bool has_exact_winding() const { return has_exact_winding_; }

 private:
  // The functions that return bool set the result and return true, or return false if they cannot
  // decide.
  bool search_mask();
  SideResult cross_out();
  bool use_lookup(const octree::MaskLookup& found);
  bool cross_to_corner(const octree::MaskLookup& found);
  bool decide_by_slab(const octree::MaskLookup& found);
  template <class Grid>
  bool cross_within_octant(const octree::MaskLookup& found, const Grid& grid);
  bool cross_to_nearest_end(const octree::MaskLookup& found);
  bool cross_to(const octree::Point& end, std::int64_t winding, SideReason::Rule rule);
  bool finalize(const octree::Point& end, std::int64_t winding, const octree::Crossings& crossings,
                SideReason::Rule rule);
  void set_result(std::int64_t winding, bool on_surface);

  const ModelGeometry& model_;
  const octree::Point& point_;
  std::uint64_t max_work_;
  const octree::PageReader& pages_;
  octree::TraversalStats& work_;
  SideReason* const reason_;  // may be null
  SideCache* const cache_;    // null: not used
  const octree::SideGrid::Lookup* const lookup_;
  std::uint64_t work_before_;
  SideResult side_result_;
  bool has_exact_winding_ = false;
};

}  // namespace planetree::query
