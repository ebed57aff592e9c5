#include "octree/nearest/best_triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double down(double value) { return std::max(0.0, value - std::fabs(value) * kEndRounding); }
double up(double value) {
  return value + value * kEndRounding + std::numeric_limits<double>::min();
}

// Lower bound on the distance to the model, from its box alone.
double distance_to_box(const TreeInfo& tree, const Point& query) {
  const Point gap = (tree.box_lower - query).cwiseMax(query - tree.box_upper).cwiseMax(0.0);
  return std::max(0.0, gap.norm() * (1 - kNormRounding) - kUnresolvedLength);
}

NearestAnswer beyond(const NearestLimits& limits) {
  NearestAnswer answer;
  answer.distance = answer.upper = kInfinity;
  answer.lower = limits.max_distance;
  answer.status = Status::kBeyondMaxDistance;
  return answer;
}

// Answers where no triangle was found and pages or work were missing. One vertex of the model is
// known, and the bounds of what was skipped.
NearestAnswer nothing_read(const TreeInfo& tree, const Point& query, double lower, double within) {
  NearestAnswer answer;
  const double distance = (query - tree.sample).norm();
  answer.point = tree.sample;
  answer.upper = std::min(up(distance * (1 + kNormRounding) + kUnresolvedLength), up(within));
  answer.distance = answer.upper;
  answer.lower = std::min(lower, down(distance * (1 - kNormRounding) - kUnresolvedLength));
  answer.feature = Feature::kVertex;
  answer.status = Status::kDegraded;
  return answer;
}

// Whether skipped children of this least squared bound may hold the nearest triangle. An infinite
// bound means that none were skipped. It is tested by itself because the threshold is infinite too
// where the query is too far away for float.
bool may_matter(float bound, const BestTriangle& best) {
  return bound < std::numeric_limits<float>::infinity() && bound <= best.exact_threshold();
}

void answer_with(const BestTriangle& best, NearestAnswer& answer) {
  best.write_nearest(answer);
  answer.distance = std::sqrt(answer.value.squared);
  answer.lower = down(best.lower());
  answer.upper = up(answer.distance + answer.value.error);
  answer.triangle = best.triangle();
  answer.corners = best.corners();
  answer.is_height_field = best.is_height_field();
  answer.status = Status::kExact;
}

}  // namespace

NearestAnswer finalize(const TreeInfo& tree, const Point& query, const NearestLimits& limits,
                       const BestTriangle& best, const FloatQuery& float_query,
                       const SkippedBounds& skipped) noexcept {
  // One variable, which the compiler can build in the caller's memory.
  NearestAnswer answer;
  const bool is_incomplete = may_matter(skipped.unread, best);
  const auto bound_of = [&](float squared) {
    return std::max(distance_to_box(tree, query), certified(float_query, squared));
  };
  if (!best.found()) {
    if (is_incomplete)
      answer = nothing_read(tree, query, std::min(limits.max_distance, bound_of(skipped.unread)),
                            skipped.within);
    else if (limits.max_distance < kInfinity)
      answer = beyond(limits);
    else  // The bounds of a forged file exclude all of its triangles, so they prove nothing.
      answer = nothing_read(tree, query, 0, kInfinity);
    return answer;
  }
  answer_with(best, answer);
  if (may_matter(skipped.pruned, best)) {
    answer.lower = std::min(answer.lower, bound_of(skipped.pruned));
    answer.status = Status::kWithinError;
  }
  // Tested after the bounds of what max_error skipped: that may be nearer than the triangle found.
  if (answer.lower > limits.max_distance && !is_incomplete) {
    answer = beyond(limits);
  } else if (is_incomplete) {
    answer.lower = std::min(answer.lower, bound_of(skipped.unread));
    answer.upper = std::min(answer.upper, up(skipped.within));
    answer.status = Status::kDegraded;
  }
  return answer;
}

}  // namespace planetree::octree
