#include "query/answer/contact_normal.h"

#include <algorithm>

#include "octree/geometry/predicates.h"
#include "octree/geometry/strict_math.h"

namespace planetree::query {
namespace {

using octree::Point;

/// Minimum distance of a query from its nearest point, as a share of the largest coordinate, for
/// the direction between them to be used. The nearest point is rounded, so a shorter one is noise.
constexpr double kMinShare = 0x1p-36;

double largest_coordinate(const octree::Triangle& triangle) {
  double largest = 0;
  for (const Point& corner : triangle) largest = std::max(largest, corner.cwiseAbs().maxCoeff());
  return largest;
}

/// Returns 1 if the normal points towards the (perturbed) query, -1 if it points away, and 0 if
/// rounding leaves that uncertain.
int towards_query(const Point& query, const octree::NearestAnswer& nearest, Side side,
                  const Point& normal) {
  if (nearest.feature == Feature::kFace) return octree::perturbed_side(nearest.corners, query);
  if (side == Side::kOnSurface ||
      nearest.distance < kMinShare * largest_coordinate(nearest.corners))
    return 0;
  const double along = (query - nearest.point).dot(normal);
  return along > 0 ? 1 : along < 0 ? -1 : 0;
}

/// Returns whether the normal points into the solid: away from a query that is outside, or towards
/// one that is inside. If that is uncertain, the sign of the winding number tells the orientation
/// of the faces. So it does for a query on a surface that is not watertight, since there both sides
/// of the surface may be outside.
bool points_inward(const Point& query, const octree::NearestAnswer& nearest,
                   const SideResult& side_result, const Point& normal) {
  if (side_result.side == Side::kUnknown) return false;
  // Nothing lies between the query and its nearest triangle. That is not known of other triangles.
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
