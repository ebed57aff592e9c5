#include "query/answer/missing_surface.h"

#include <algorithm>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"

namespace planetree::query {

double clearance(const ModelGeometry& model, const octree::Point& point, bool far) {
  if (!model.region.has_walls()) return std::numeric_limits<double>::infinity();
  return far ? 0 : model.region.clearance(point, model.tree.span(point));
}

void account_for_missing_surface(const octree::TreeInfo& tree, const octree::Point& point,
                                 double clear, double max_distance,
                                 octree::NearestAnswer& nearest) {
  const bool beyond = nearest.status == Status::kBeyondMaxDistance;
  if (beyond ? max_distance <= clear : nearest.upper < clear) return;
  // A missing triangle may be nearer.
  nearest.lower = std::max(0.0, std::min(nearest.lower, clear));
  nearest.status = Status::kDegraded;
  if (!beyond) return;
  nearest.point = tree.sample;
  nearest.upper =
      (point - tree.sample).norm() * (1 + octree::kNormRounding) + octree::kUnresolvedLength;
  nearest.distance = nearest.upper;
  nearest.feature = Feature::kVertex;
}

}  // namespace planetree::query
