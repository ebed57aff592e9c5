#include "query/answer/far_query.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "query/answer/closest_point.h"

namespace planetree::query {

octree::NearestAnswer farthest(const octree::TreeInfo& tree, const octree::Point& from) {
  octree::NearestAnswer nearest;
  nearest.point = nearest.corners[0] = tree.sample;
  nearest.triangle = tree.sample_triangle;
  nearest.distance = from.norm();
  nearest.barycentric = {1, 0, 0};
  nearest.feature = Feature::kVertex;
  nearest.status = Status::kExact;
  return nearest;
}

void measure_far(const Vec3& query, const QueryOptions& options, ClosestPoint& answer) {
  const double largest = std::max({std::fabs(query.x), std::fabs(query.y), std::fabs(query.z)});
  const double x = query.x / largest, y = query.y / largest, z = query.z / largest;
  answer.distance = largest * std::sqrt(x * x + y * y + z * z);
  if (answer.distance > options.max_distance) {
    answer = unanswered(Status::kBeyondMaxDistance);
    answer.lower = options.max_distance;
    return;
  }
  answer.upper = answer.distance * (1 + octree::kNormRounding);
  answer.lower =
      std::min(answer.distance, std::numeric_limits<double>::max()) * (1 - octree::kNormRounding);
}

}  // namespace planetree::query
