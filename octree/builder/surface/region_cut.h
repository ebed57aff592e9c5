#pragma once

#include <cstdint>
#include <mutex>

#include "octree/builder/sort/triangle_runs.h"
#include "octree/builder/sort/triangles.h"
#include "octree/builder/surface/edge_crossings.h"
#include "octree/geometry/region.h"
#include "planetree/error.h"

namespace planetree::octree {

/// What must be known of a whole surface to build a part of it.
struct SurfaceCut {
  std::uint64_t triangle_count = 0;  ///< of the part
  std::uint64_t sample_triangle = kNoTriangle;
  Point sample = Point::Zero();  ///< corner 0 of that, the first of them; model frame
  std::int64_t winding = 0;      ///< of the whole about the least corner of the mask's root
};

/// Looks at every triangle of a surface: takes those that touch a region, and counts how often
/// the surface winds about one point, from which the mask goes on.
///
/// source  the winding number outside of the model's box is 0; a way out of it along an axis,
///         cell by cell from there, is ours.
class RegionCut {
 public:
  /// box_lower, box_upper  of the whole surface.
  /// region                if none of it is cut off, all triangles are taken.
  /// kept                  takes copies of the triangles; null: nothing is taken.
  RegionCut(const Point& box_lower, const Point& box_upper, const Region& region,
            TriangleRuns* kept);

  /// A part of the surface, each triangle once, in any order. Any number of threads.
  Result<void> add(const Triangles& triangles);

  /// After the last part.
  const SurfaceCut& found() const { return found_; }

 private:
  SurfaceCut look_at(const Triangles& triangles, Triangles& taken) const;

  const Point lower_, upper_;  // of the region, as far as it is in the model's box
  const DownwardSegment way_out_;
  TriangleRuns* const kept_;
  std::mutex mutex_;
  SurfaceCut found_;
};

}  // namespace planetree::octree
