#include "octree/nearest/best_triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/nearest/interval_ends.h"

namespace planetree::octree {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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
  answer.upper =
      std::min(upper_end(distance * (1 + kNormRounding) + kUnresolvedLength), upper_end(within));
  answer.distance = answer.upper;
  answer.lower = std::min(lower, lower_end(distance * (1 - kNormRounding) - kUnresolvedLength));
  answer.feature = Feature::kVertex;
  answer.status = Status::kDegraded;
  return answer;
}

// Answers by the coarse field where no triangle was found. `lower` bounds what was skipped.
void answer_with(const FieldBounds& bounds, double lower, NearestAnswer& answer) {
  answer.point = bounds.point;
  answer.upper = upper_end(bounds.upper);
  answer.distance = answer.upper;
  answer.lower = lower_end(std::max(bounds.lower, lower));
  answer.feature = Feature::kVertex;
  answer.barycentric = {};
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
  answer.lower = lower_end(best.lower());
  answer.upper = upper_end(answer.distance + answer.value.error);
  answer.triangle = best.triangle();
  answer.corners = best.corners();
  answer.is_height_field = best.is_height_field();
  answer.status = Status::kExact;
}

// The rounding of both ends of the interval is part of the error.
bool is_within_error(const NearestAnswer& answer, const NearestLimits& limits) {
  return answer.upper - answer.lower + kValueRounding * answer.upper <= limits.max_error;
}

// The bounds of the coarse field; its upper end is no greater than what the search was told.
FieldBounds bounds_of(const CoarseField& field, const Point& query) {
  FieldBounds bounds = field.bounds(query);
  const FieldBounds told = field.upper_bound(query);
  if (told.upper < bounds.upper) {
    bounds.upper = told.upper;
    bounds.point = told.point;
  }
  return bounds;
}

// Whether the point of an answer is known to be within `upper`. The sample may be farther than the
// box that gave the upper end.
bool has_point(const Point& query, const NearestAnswer& answer, double upper) {
  return answer.triangle != kNoTriangle ||
         (query - answer.point).norm() * (1 - kNormRounding) <= upper;
}

// Narrows the interval of an answer that is not exact by the coarse field. A forged field may
// contradict the tree; then it is not used.
void narrow(const Point& query, const NearestLimits& limits, NearestAnswer& answer) {
  if (!limits.field || limits.field->is_empty()) return;
  const FieldBounds bounds = bounds_of(*limits.field, query);
  const double lower = std::max(answer.lower, lower_end(bounds.lower));
  const double field_upper = upper_end(bounds.upper);
  // Within an error, the triangle found is near enough: its distance stays in the interval.
  const bool keeps_upper = answer.status == Status::kWithinError &&
                           answer.triangle != kNoTriangle && is_within_error(answer, limits);
  double upper = keeps_upper ? answer.upper : std::min(answer.upper, field_upper);
  if (!(lower < upper)) return;
  // The search may have left out all triangles as near as the field's point.
  const bool is_farther =
      answer.triangle != kNoTriangle && !keeps_upper && field_upper < answer.distance;
  if (is_farther || !has_point(query, answer, field_upper)) {
    const bool must_have_point = answer.status == Status::kWithinError;
    answer.triangle = kNoTriangle;
    answer_with(bounds, 0, answer);
    if (must_have_point) upper = field_upper;
  }
  if (answer.triangle == kNoTriangle) answer.distance = upper;
  answer.lower = lower;
  answer.upper = upper;
  if (has_point(query, answer, upper) && answer.distance <= upper &&
      is_within_error(answer, limits))
    answer.status = Status::kWithinError;
}

// Widens the interval of an answer for what was skipped and may be nearer, then narrows it by the
// field.
[[gnu::noinline]] void account_for_skipped(const TreeInfo& tree, const Point& query,
                                           const NearestLimits& limits,
                                           const FloatQuery& float_query,
                                           const SkippedBounds& skipped, bool is_pruned,
                                           bool is_incomplete, NearestAnswer& answer) {
  const auto bound_of = [&](float squared) {
    return std::max(distance_to_box(tree, query), certified(float_query, squared));
  };
  if (is_pruned) {
    answer.lower = std::min(answer.lower, bound_of(skipped.pruned));
    answer.status = Status::kWithinError;
  }
  if (is_incomplete) {
    answer.lower = std::min(answer.lower, bound_of(skipped.unread));
    answer.upper = std::min(answer.upper, upper_end(skipped.within));
    answer.status = Status::kDegraded;
  }
  narrow(query, limits, answer);
}

}  // namespace

bool answer_by_field(const Point& query, const NearestLimits& limits,
                     NearestAnswer& answer) noexcept {
  const FieldBounds bounds = limits.field->bounds(query);
  if (!bounds.are_known()) return false;
  answer_with(bounds, 0, answer);
  if (!is_within_error(answer, limits) ||
      answer.upper - answer.lower > limits.max_field_share * answer.lower)
    return false;
  if (answer.lower > limits.max_distance)
    answer = beyond(limits);
  else if (answer.upper > limits.max_distance)
    return false;
  else
    answer.status = Status::kWithinError;
  return true;
}

NearestAnswer finalize(const TreeInfo& tree, const Point& query, const NearestLimits& limits,
                       const BestTriangle& best, const FloatQuery& float_query,
                       const SkippedBounds& skipped) noexcept {
  // One variable, which the compiler can build in the caller's memory.
  NearestAnswer answer;
  const bool is_incomplete = may_matter(skipped.unread, best);
  const bool is_pruned = may_matter(skipped.pruned, best);
  if (best.found()) {
    answer_with(best, answer);
  } else if (is_incomplete || is_pruned) {
    answer = nothing_read(tree, query, limits.max_distance, skipped.within);
  } else {
    // The bounds of a forged file may exclude all of its triangles. Then they prove nothing.
    return limits.max_distance < kInfinity ? beyond(limits)
                                           : nothing_read(tree, query, 0, kInfinity);
  }
  if (is_incomplete || is_pruned) [[unlikely]]
    account_for_skipped(tree, query, limits, float_query, skipped, is_pruned, is_incomplete,
                        answer);
  // Tested after the bounds of what max_error skipped: that may be nearer than the triangle found.
  if (answer.lower > limits.max_distance) answer = beyond(limits);
  return answer;
}

}  // namespace planetree::octree
