#include "tests/oracle/answer_evidence.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/triangle_distance.h"
#include "tests/oracle/interval_oracle.h"
#include "tests/oracle/ray_crossing.h"

namespace planetree::oracle {
namespace {

octree::Point point(const Vec3& p) { return {p.x, p.y, p.z}; }

bool is_within(const Vec3& query, const Corners& triangle, double distance) {
  return !std::isfinite(distance) || compare_distance(query, triangle, distance) <= 0;
}

bool is_nearer(const Vec3& query, const Corners& triangle, double distance) {
  return !std::isfinite(distance) || compare_distance(query, triangle, distance) < 0;
}

const char* word(Side side) {
  return side == Side::kInside ? "inside" : side == Side::kOutside ? "outside" : "on the surface";
}

}  // namespace

double AnswerEvidence::reach() const {
  // Without a triangle to compare with `upper`, any triangle within `upper` suffices.
  const bool any = !names_triangle() && std::isfinite(answer_->upper);
  return is_exact() || any ? answer_->upper : answer_->lower;
}

void AnswerEvidence::add_near(std::uint64_t index, const Corners& triangle) {
  const Vec3& query = answer_->query;
  if (answer_->lower == 0 && compare_distance(query, triangle, 0) == 0) on_surface_ = true;
  if (answer_->lower > 0 && is_nearer(query, triangle, answer_->lower))
    nearer_ = std::min(nearer_, index);
  if (!names_triangle()) reached_ = reached_ || is_within(query, triangle, answer_->upper);
  if (!is_exact()) return;
  // The first of the nearest is decided in double, where triangles that share the nearest vertex or
  // edge have the same bits.
  const double squared =
      octree::triangle_value(point(query),
                             {point(triangle[0]), point(triangle[1]), point(triangle[2])})
          .squared;
  if (squared > min_squared_ || (squared == min_squared_ && index >= first_)) return;
  min_squared_ = squared;
  first_ = index;
}

void AnswerEvidence::add_named(const Corners& triangle) {
  named_seen_ = true;
  named_within_ = is_within(answer_->query, triangle, answer_->upper);
}

void AnswerEvidence::add_ahead(const Corners& triangle) {
  crossings_ += ray_crossing(answer_->query, triangle);
}

// Whether the upper end comes from the box of a subtree that was skipped, and not from the triangle
// named, which is farther.
static bool is_box_nearer(const AnswerRow& answer) {
  return answer.status == Status::kDegraded && answer.distance > answer.upper;
}

std::string AnswerEvidence::fault() const {
  const AnswerRow& a = *answer_;
  if (!is_finite(a.query)) return "nothing can be answered to this query";
  if (!(0 <= a.lower && a.lower <= a.distance && (a.distance <= a.upper || is_box_nearer(a))))
    return "the distance is not within the interval";
  if (nearer_ != kNoTriangle)
    return "triangle " + std::to_string(nearer_) + " is nearer than the interval says";
  if (!names_triangle()) {
    if (is_exact()) return "an exact answer names no triangle";
    return reached_ || !std::isfinite(a.upper) ? "" : "no triangle is within the interval";
  }
  if (!named_seen_) return "the mesh has no such triangle";
  if (!named_within_ && !is_box_nearer(a))
    return "the triangle named is farther than the interval says";
  if (first_ != kNoTriangle && first_ != a.triangle)
    return "triangle " + std::to_string(first_) + " comes before the one named";
  return {};
}

std::string AnswerEvidence::side_fault() const {
  return oracle::side_fault(*answer_, on_surface_       ? Side::kOnSurface
                                      : crossings_ != 0 ? Side::kInside
                                                        : Side::kOutside);
}

std::string side_fault(const AnswerRow& answer, Side truth) {
  if (answer.side == truth) return {};
  if (answer.side == Side::kUnknown && answer.status == Status::kDegraded) return {};
  return std::string("the point is ") + word(truth);
}

}  // namespace planetree::oracle
