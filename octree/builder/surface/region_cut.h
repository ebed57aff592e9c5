#pragma once

#include <cstdint>
#include <mutex>

#include "octree/builder/job/model_frame.h"
#include "octree/builder/sort/triangle_runs.h"
#include "octree/builder/sort/triangles.h"
#include "octree/builder/surface/edge_crossings.h"
#include "octree/geometry/cell_grid.h"
#include "planetree/error.h"

namespace planetree::octree {

/// What building a part of a surface needs to know of the whole surface.
struct SurfaceCut {
  std::uint64_t triangle_count = 0;             ///< triangles of the part
  std::uint64_t sample_triangle = kNoTriangle;  ///< the least index in the part
  Point sample = Point::Zero();                 ///< corner 0 of sample_triangle; model frame
  std::int64_t winding = 0;  ///< winding number of the whole surface at the mask's least corner
};

/// Goes through all triangles of a surface. Takes those that touch a region, and counts the winding
/// number of the surface at one point, from which the mask goes on.
///
/// source  the winding number outside of the model's box is 0. The segment out of the box along an
///         axis, and going on cell by cell from its end, are ours.
class RegionCut {
 public:
  /// frame   of the whole surface.
  /// region  if it has no walls, all triangles are taken.
  /// kept    receives copies of the triangles; null: none are taken.
  RegionCut(const ModelFrame& frame, const Region& region, TriangleRuns* kept);

  /// Adds a part of the surface, each triangle once, in any order. Any number of threads.
  Result<void> add(const Triangles& triangles);

  /// Counts the crossings of a cap of the surface. One thread.
  void add_cap(const Triangle& cap) {
    found_.winding += exit_segment_.crossing(BoxedTriangle(cap));
  }

  /// Adds what the triangles of a part count, where another object found that. One thread.
  void add_winding(std::int64_t winding) { found_.winding += winding; }

  /// The result, after the last part.
  const SurfaceCut& found() const { return found_; }

 private:
  SurfaceCut look_at(const Triangles& triangles, Triangles& taken) const;

  const Point lower_, upper_;  // bounds of the region within the model's box
  const DownwardSegment exit_segment_;
  TriangleRuns* const kept_;
  std::mutex mutex_;
  SurfaceCut found_;
};

}  // namespace planetree::octree
