#include "query/answer/contact_normal.h"

#include <algorithm>

#include "octree/geometry/predicates.h"
#include "octree/geometry/strict_math.h"

namespace planetree::query {
namespace {

using octree::Point;

/// Nearer than this share of coordinates to a nearest point, which is rounded,
/// the way from there to the query says nothing.
constexpr double kMinShare = 0x1p-36;

double largest_coordinate(const octree::Triangle& triangle) {
  double largest = 0;
  for (const Point& corner : triangle) largest = std::max(largest, corner.cwiseAbs().maxCoeff());
  return largest;
}

/// Whether the normal points to where the query is, or a step beside it: 1 or
/// -1, or 0 where that cannot be told from rounding.
int towards_query(const Point& query, const octree::NearestAnswer& nearest, Side side,
                  const Point& normal) {
  if (nearest.feature == Feature::kFace) return octree::perturbed_side(nearest.corners, query);
  if (side == Side::kOnSurface ||
      nearest.distance < kMinShare * largest_coordinate(nearest.corners))
    return 0;
  const double along = (query - nearest.point).dot(normal);
  return along > 0 ? 1 : along < 0 ? -1 : 0;
}

/// Whether the normal points into the solid: away from a query that is outside,
/// to one that is inside. Where that cannot be told, the winding number says
/// which way round the faces are; so it does on a surface that is not watertight,
/// where a step aside may be outside on either side.
bool points_inward(const Point& query, const octree::NearestAnswer& nearest,
                   const SideResult& side_result, const Point& normal) {
  if (side_result.side == Side::kUnknown) return false;
  // Only of the nearest triangle is it known that nothing is between it and the query.
  if (nearest.status != Status::kExact || !side_result.beside) return side_result.winding < 0;
  const int towards = towards_query(query, nearest, side_result.side, normal);
  if (towards == 0) return side_result.winding < 0;
  return (towards > 0) == (side_result.winding != 0);
}

}  // namespace

Point contact_normal(const Point& query, const octree::NearestAnswer& nearest,
                     const octree::FeatureNormal& feature, const SideResult& side_result) noexcept {
  if (!(feature.normal.squaredNorm() > 0)) return {0, 0, 1};
  return points_inward(query, nearest, side_result, feature.normal) ? Point(-feature.normal)
                                                                    : feature.normal;
}

}  // namespace planetree::query
