#include "query/closest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/strict_math.h"
#include "query/side.h"

namespace planetree::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool makes_sense(const Vec3& query, const Ask& ask) {
  return std::isfinite(query.x) && std::isfinite(query.y) && std::isfinite(query.z) &&
         ask.max_error >= 0 && std::isfinite(ask.max_error) && ask.max_distance >= 0 &&
         (ask.parts & ~kAllParts) == 0;
}

// Beyond octree::kFarthestQuery all triangles are equally far in double.
ClosestPoint far_answer(const ModelState& model, const Vec3& query, const Ask& ask) {
  const double largest = std::max({std::fabs(query.x), std::fabs(query.y), std::fabs(query.z)});
  const double x = query.x / largest, y = query.y / largest, z = query.z / largest;
  ClosestPoint answer;
  answer.distance = largest * std::sqrt(x * x + y * y + z * z);
  if (answer.distance > ask.max_distance) {
    answer.distance = answer.upper = kInfinity;
    answer.lower = ask.max_distance;
    answer.status = Status::kBeyondMaxDistance;
    return answer;
  }
  answer.upper = answer.distance * (1 + 0x1p-48);
  answer.lower = std::min(answer.distance, std::numeric_limits<double>::max()) * (1 - 0x1p-48);
  answer.point = model.scale().out(model.tree().sample);
  answer.triangle = model.tree().sample_triangle;
  answer.barycentric = {1, 0, 0};
  answer.feature = Feature::kVertex;
  answer.status = Status::kExact;
  return answer;
}

ClosestPoint in_model_units(const Scale& scale, const octree::NearestAnswer& nearest) {
  ClosestPoint answer;
  answer.distance = scale.out(nearest.distance);
  answer.lower = std::min(scale.out_below(nearest.lower), std::numeric_limits<double>::max());
  answer.upper = std::max(scale.out_above(nearest.upper), std::nextafter(answer.lower, kInfinity));
  answer.point = scale.out(nearest.point);
  answer.triangle = nearest.triangle;
  answer.barycentric = {nearest.barycentric[0], nearest.barycentric[1], nearest.barycentric[2]};
  answer.feature = nearest.feature;
  answer.status = nearest.status;
  return answer;
}

// Everything but the side.
ClosestPoint nearest_answer(const ModelState& model, const octree::Point& point, const Ask& ask,
                            octree::PageReader pages, octree::TreeWork& work) {
  octree::NearestLimits limits;
  limits.max_error = model.scale().in(ask.max_error);
  limits.max_distance = model.scale().in(ask.max_distance);
  limits.max_nodes = ask.max_nodes;
  ClosestPoint answer =
      in_model_units(model.scale(), octree::nearest(model.tree(), point, limits, pages, work));
  if (answer.status == Status::kBeyondMaxDistance) answer.lower = ask.max_distance;
  return answer;
}

// As if no triangle was reached.
ClosestPoint without_distance(Status status) {
  ClosestPoint answer;
  answer.distance = answer.upper = kInfinity;
  answer.status = status;
  return answer;
}

}  // namespace

ClosestPoint closest_point(ProbeState& probe, const Vec3& query, const Ask& ask) noexcept {
  if (!makes_sense(query, ask)) return without_distance(Status::kBadQuery);
  const ModelState& model = probe.model();
  const octree::Point point = model.scale().in(query);
  const bool far = !(point.cwiseAbs().maxCoeff() <= octree::kFarthestQuery);
  PageTurner turner(probe.reader());
  octree::TreeWork work;
  ClosestPoint answer = without_distance(Status::kExact);
  if ((ask.parts & kDistance) != 0)
    answer = far ? far_answer(model, query, ask)
                 : nearest_answer(model, point, ask, turner.pages(), work);
  if ((ask.parts & kSide) != 0) {
    const Containment found = find_side(model, point, ask.max_nodes, turner.pages(), work);
    answer.side = found.side;
    if (found.status == Status::kDegraded && answer.status != Status::kBeyondMaxDistance)
      answer.status = found.status;
  }
  if (answer.status == Status::kDegraded) model.count_degraded();
  return answer;
}

Containment contains(ProbeState& probe, const Vec3& query, const Ask& ask) noexcept {
  if (!makes_sense(query, ask)) return {};
  const ModelState& model = probe.model();
  PageTurner turner(probe.reader());
  octree::TreeWork work;
  const Containment found =
      find_side(model, model.scale().in(query), ask.max_nodes, turner.pages(), work);
  if (found.status == Status::kDegraded) model.count_degraded();
  return found;
}

}  // namespace planetree::query
