#include "octree/builder/surface/region_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "octree/geometry/cell_overlap.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

// A segment from `from` straight out of the model's box.
DownwardSegment exit_segment(const Point& from, const Point& box_lower) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Point outside = from;
  outside.x() = std::min(box_lower.x() - 1, std::nextafter(box_lower.x(), -kInfinity));
  return DownwardSegment({from, outside}, 0);
}

}  // namespace

RegionCut::RegionCut(const ModelFrame& frame, const Region& region, TriangleRuns* kept)
    : lower_(region.clamped(frame.lower())),
      upper_(region.clamped(frame.upper())),
      exit_segment_(exit_segment(region.clamped(frame.core_lower()), frame.lower())),
      kept_(kept) {}

SurfaceCut RegionCut::look_at(const Triangles& triangles, Triangles& taken) const {
  SurfaceCut found;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle triangle = triangles.corners(i);
    found.winding += exit_segment_.crossing(BoxedTriangle(triangle));
    if (kept_ == nullptr || !may_touch(triangle, lower_, upper_)) continue;
    taken.add(triangles.key(i), triangle);
    if (triangles.index(i) >= found.sample_triangle) continue;
    found.sample_triangle = triangles.index(i);
    found.sample = triangle[0];
  }
  found.triangle_count = taken.size();
  return found;
}

Result<void> RegionCut::add(const Triangles& triangles) {
  Triangles taken(triangles.float64());
  const SurfaceCut found = look_at(triangles, taken);
  if (taken.size() > 0)
    if (const auto added = kept_->add(std::move(taken)); !added) return added;
  const std::lock_guard lock(mutex_);
  found_.winding += found.winding;
  found_.triangle_count += found.triangle_count;
  if (found.sample_triangle < found_.sample_triangle) {
    found_.sample_triangle = found.sample_triangle;
    found_.sample = found.sample;
  }
  return {};
}

}  // namespace planetree::octree
