#include "query/answer/side.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/predicates.h"
#include "octree/geometry/strict_math.h"
#include "octree/mask/mask_lookup.h"
#include "octree/nearest/nearest.h"
#include "octree/winding/winding_number.h"
#include "query/answer/query_context.h"
#include "query/answer/side_search.h"

namespace planetree::query {
namespace {

using octree::Point;

SideResult by_crossings(const ModelGeometry& model, const Point& point, std::uint64_t max_work,
                        const octree::PageReader& pages, octree::TraversalStats& work,
                        SideReason* reason) {
  if (outside_box(model.tree, point)) {
    if (reason) reason->rule = SideReason::Rule::kOutsideBox;
    return {Side::kOutside};
  }
  return SideSearch(model, point, max_work, pages, work, reason).run();
}

// Returns whether the triangles missing from a file of a region may change a point's side: beyond a
// wall of the region; and anywhere in a model that is not watertight, where winding numbers are not
// constant off the surface.
bool is_unknowable(const ModelGeometry& model, const Point& point) {
  const octree::Region& region = model.region;
  return region.has_walls() && (!region.holds(point) || !model.watertight);
}

// Rounds to the nearest whole number; clamps to +-2^62.
std::int64_t rounded(double value) {
  constexpr double kMaxWindingNumber = 0x1p62;  // fits std::int64_t
  return static_cast<std::int64_t>(
      std::clamp(value + (value < 0 ? -0.5 : 0.5), -kMaxWindingNumber, kMaxWindingNumber));
}

SideResult by_winding_number(const octree::TreeInfo& tree, const Point& point,
                             std::uint64_t max_work, const octree::PageReader& pages,
                             octree::TraversalStats& work, SideReason* reason) {
  if (reason) reason->rule = SideReason::Rule::kWindingNumber;
  // Seen from so far away, all triangles together have no measurable solid angle.
  if (!(point.cwiseAbs().maxCoeff() <= octree::kMaxQueryCoordinate)) return {Side::kOutside};
  const octree::WindingNumber w = octree::winding_number(tree, point, max_work, pages, work);
  if (reason) {
    reason->value = w.value;
    reason->error = w.error;
  }
  if (w.on_surface) {
    const int sign = w.sign_is_certain() ? (w.value < 0 ? -1 : 1) : 0;
    return {Side::kOnSurface, Status::kExact, sign, false, w.complete};
  }
  if (w.above_half()) return {Side::kInside, Status::kExact, rounded(w.value)};
  if (w.below_half()) return {Side::kOutside, Status::kExact};
  return {Side::kUnknown, w.complete ? Status::kExact : Status::kDegraded};
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
  if (is_unknowable(model, point)) {
    if (reason) reason->rule = SideReason::Rule::kRegion;
    return {};
  }
  return model.watertight ? by_crossings(model, point, max_work, pages, work, reason)
                          : by_winding_number(model.tree, point, max_work, pages, work, reason);
}

std::optional<SideResult> side_without_pages(const ModelGeometry& model, const Point& point,
                                             const octree::SideGrid::Lookup& lookup) noexcept {
  if (lookup.winding != octree::SideGrid::kUnknown)
    return SideResult{lookup.winding != 0 ? Side::kInside : Side::kOutside, Status::kExact,
                      lookup.winding};
  if (is_unknowable(model, point)) return SideResult{};
  if (model.watertight && outside_box(model.tree, point)) return SideResult{Side::kOutside};
  return {};
}

bool is_cached_side(const ModelGeometry& model, const Point& point, double clear,
                    SideCache& cache) noexcept {
  if (!model.region.holds(point) || !cache.same_side(point, clear)) return false;
  cache.move_to(point, clear);
  return true;
}

SideResult find_side(const ModelGeometry& model, const Point& point,
                     const octree::SideGrid::Lookup& lookup, double clear, SideCache& cache,
                     std::uint64_t max_work, const octree::PageReader& pages,
                     octree::TraversalStats& work) noexcept {
  if (!model.watertight || !model.region.holds(point) || outside_box(model.tree, point))
    return find_side(model, point, max_work, pages, work);
  if (is_cached_side(model, point, clear, cache)) return cache.side_result();
  SideSearch search(model, point, max_work, pages, work, nullptr, {&cache, &lookup});
  const SideResult side_result = search.run();
  if (side_result.status == Status::kExact)
    cache.note(point, side_result, search.has_exact_winding(), clear);
  return side_result;
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

Point contact_normal(const Point& query, const octree::NearestAnswer& nearest,
                     const octree::FeatureNormal& feature, const SideResult& side_result,
                     octree::WorkLimit& limit) noexcept {
  if (!(feature.normal.squaredNorm() > 0)) return {0, 0, 1};
  return points_inward(query, nearest, side_result, feature.normal, limit) ? Point(-feature.normal)
                                                                           : feature.normal;
}

}  // namespace planetree::query
