#include "query/answer/side.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/predicates.h"
#include "octree/geometry/strict_math.h"
#include "octree/mask/mask_lookup.h"
#include "octree/nearest/nearest.h"
#include "query/answer/open_side.h"
#include "query/answer/query_context.h"
#include "query/answer/side_search.h"

namespace planetree::query {
namespace {

using octree::Point;

// The triangles missing from a file of a region may change sides beyond its walls.
constexpr SideResult kBeyondWall{Side::kUnknown, Status::kDegraded};

// Takes the caps' share from what a search found, if the surface has caps.
SideResult less_caps(const ModelGeometry& model, const Point& point, const SideResult& closed,
                     SideSearch& search, const octree::PageReader& pages,
                     octree::TraversalStats& work, SideReason* reason) {
  if (!model.tree.caps) return closed;
  return OpenSide(model, point, search.work_left(), pages, work, reason, &search).run(closed);
}

// Finds the side of a point of the region.
SideResult find_known_side(const ModelGeometry& model, const Point& point, std::uint64_t max_work,
                           const octree::PageReader& pages, octree::TraversalStats& work,
                           SideReason* reason) {
  if (outside_box(model.tree, point)) {
    if (reason) reason->rule = SideReason::Rule::kOutsideBox;
    if (!model.tree.caps) return {Side::kOutside};
    return OpenSide(model, point, max_work, pages, work, reason, nullptr).run({Side::kOutside});
  }
  SideSearch search(model, point, max_work, pages, work, reason);
  return less_caps(model, point, search.run(), search, pages, work, reason);
}

double largest_coordinate(const octree::Triangle& triangle) {
  double largest = 0;
  for (const Point& corner : triangle) largest = std::max(largest, corner.cwiseAbs().maxCoeff());
  return largest;
}

/// Returns 1 if the normal points towards the (perturbed) query, -1 if it points away, and 0 if
/// rounding leaves that uncertain.
int towards_query(const Point& query, const octree::NearestAnswer& nearest, Side side,
                  const Point& normal, octree::WorkLimit& limit) {
  if (nearest.feature == Feature::kFace)
    return octree::perturbed_side(nearest.corners, query, &limit);
  if (side == Side::kOnSurface ||
      nearest.distance < octree::kMinDirectionShare * largest_coordinate(nearest.corners))
    return 0;
  const double along = (query - nearest.point).dot(normal);
  return along > 0 ? 1 : along < 0 ? -1 : 0;
}

/// Returns whether the normal points into the solid: away from a query that is outside, or towards
/// one that is inside. If that is uncertain, the sign of the winding number tells the orientation
/// of the faces. So it does for a query on a surface that is not watertight, since there both sides
/// of the surface may be outside.
bool points_inward(const Point& query, const octree::NearestAnswer& nearest,
                   const SideResult& side_result, const Point& normal, octree::WorkLimit& limit) {
  if (side_result.side == Side::kUnknown) return false;
  // Nothing lies between the query and its nearest triangle. That is not known of other triangles.
  if (nearest.status != Status::kExact || !side_result.beside) return side_result.winding < 0;
  const int towards = towards_query(query, nearest, side_result.side, normal, limit);
  if (limit.exceeded()) return false;
  if (towards == 0) return side_result.winding < 0;
  return (towards > 0) == (side_result.winding != 0);
}

}  // namespace

SideResult find_side(const ModelGeometry& model, const Point& point, std::uint64_t max_work,
                     const octree::PageReader& pages, octree::TraversalStats& work,
                     SideReason* reason) noexcept {
  if (reason) *reason = {};
  if (!model.region.holds(point)) {
    if (reason) reason->rule = SideReason::Rule::kRegion;
    return kBeyondWall;
  }
  return find_known_side(model, point, max_work, pages, work, reason);
}

std::optional<SideResult> side_without_pages(const ModelGeometry& model, const Point& point,
                                             const octree::SideGrid::Lookup& lookup) noexcept {
  if (lookup.winding != octree::SideGrid::kUnknown)
    return SideResult{lookup.winding != 0 ? Side::kInside : Side::kOutside, Status::kExact,
                      lookup.winding};
  if (!model.region.holds(point)) return kBeyondWall;
  if (!model.tree.caps && outside_box(model.tree, point)) return SideResult{Side::kOutside};
  return {};
}

bool is_cached_side(const ModelGeometry& model, const Point& point, double clear,
                    SideCache& cache) noexcept {
  if (!model.region.holds(point) || !cache.same_side(point, clear) ||
      !model.cap_grid.is_clear_between(cache.point(), point))
    return false;
  cache.move_to(point, clear);
  return true;
}

SideResult find_side(const ModelGeometry& model, const Point& point,
                     const octree::SideGrid::Lookup& lookup, double clear, SideCache& cache,
                     std::uint64_t max_work, const octree::PageReader& pages,
                     octree::TraversalStats& work) noexcept {
  if (!model.region.holds(point) || outside_box(model.tree, point))
    return find_side(model, point, max_work, pages, work);
  if (is_cached_side(model, point, clear, cache)) return cache.side_result();
  SideSearch search(model, point, max_work, pages, work, nullptr, {&cache, &lookup});
  const SideResult closed = search.run();
  if (closed.status == Status::kExact && model.cap_grid.is_clear(point))
    cache.note(point, closed, search.has_exact_winding(), clear);
  return less_caps(model, point, closed, search, pages, work, nullptr);
}

SideResult find_containment(const QueryContext& context, const Vec3& query,
                            const octree::Point& scaled, const octree::SideGrid::Lookup& lookup,
                            const QueryOptions& options) noexcept {
  const ModelGeometry& model = context.model;
  // Decided for the query itself: within_reach() may move it beyond another wall of a region.
  if (is_far(scaled))
    if (const auto known = side_without_pages(model, scaled, lookup)) return *known;
  const octree::Point point = within_reach(scaled, query);
  if (may_use_coherence(context.coherence, options))
    return find_side(model, point, lookup, 0, context.coherence.side, max_units(options),
                     context.pages, context.work);
  return find_side(model, point, max_units(options), context.pages, context.work);
}

SideResult side_for_normal(const ModelGeometry& model, const Point& point,
                           const SideResult& on_surface, Feature feature, std::uint64_t max_work,
                           const octree::PageReader& pages, octree::TraversalStats& work) noexcept {
  const bool faces_tell = feature == Feature::kFace || on_surface.winding != 0;
  if (on_surface.side != Side::kOnSurface || (faces_tell && model.cap_grid.is_clear(point)))
    return on_surface;
  return OpenSide(model, point, max_work, pages, work, nullptr, nullptr)
      .sign_on_surface(on_surface);
}

Point contact_normal(const Point& query, const octree::NearestAnswer& nearest,
                     const octree::FeatureNormal& feature, const SideResult& side_result,
                     octree::WorkLimit& limit) noexcept {
  if (!(feature.normal.squaredNorm() > 0)) return {0, 0, 1};
  return points_inward(query, nearest, side_result, feature.normal, limit) ? Point(-feature.normal)
                                                                           : feature.normal;
}

}  // namespace planetree::query
