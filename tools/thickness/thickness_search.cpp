#include "tools/thickness/thickness_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace planetree::tools {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// A ball shrinks at least by this factor, so that it does not shrink by roundings.
constexpr double kShrinks = 1 - 0x1p-40;
constexpr int kMaxRounds = 64, kMaxLists = 8;
constexpr std::size_t kListed = 128;
// An interval that is narrower need not be narrowed by a list, as a share of the radius.
constexpr double kListedShare = 0.05;
// A narrower interval is exact, as a share of the thickness.
constexpr double kExactShare = 0x1p-30;

Vec3 reversed(const Vec3& v) { return {-v.x, -v.y, -v.z}; }

}  // namespace

const char* name_of(ThicknessStatus status) {
  switch (status) {
    case ThicknessStatus::kExact:
      return "exact";
    case ThicknessStatus::kBounded:
      return "bounded";
    case ThicknessStatus::kDegraded:
      return "degraded";
    case ThicknessStatus::kBeyond:
      return "beyond_max_thickness";
    case ThicknessStatus::kBadPoint:
      break;
  }
  return "bad_query";
}

ThicknessSearch::ThicknessSearch(Probe& probe, const ThicknessOptions& options)
    : probe_(probe), options_(options), list_(kListed) {}

void ThicknessSearch::measure(std::span<const Vec3> points, std::span<WallThickness> results) {
  begin(points, results);
  for (int round = 0; round < kMaxRounds && !open_.empty(); ++round) shrink(results);
  for (Ball& ball : open_) {
    ball.least = 0;
    listed_.push_back(ball);
  }
  std::ranges::sort(listed_, {}, &Ball::index);  // for queries near each other
  for (Ball& ball : listed_) list_and_finish(ball, results[ball.index]);
}

/// Finds the surface points, and the normals there.
void ThicknessSearch::begin(std::span<const Vec3> points, std::span<WallThickness> results) {
  open_.clear();
  listed_.clear();
  answers_.resize(points.size());
  QueryOptions options;
  options.side_rule = options_.side_rule;
  probe_.closest_points(points, answers_, options);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ClosestPoint& answer = answers_[i];
    results[i] = {kNone, 0, kInfinity, answer.point, false, {}, ThicknessStatus::kBadPoint};
    if (answer.status == Status::kBadQuery || answer.triangle == kNoTriangle) continue;
    // A point whose side or normal is not proven has a ball all the same.
    results[i].status =
        answer.status == Status::kExact ? ThicknessStatus::kBounded : ThicknessStatus::kDegraded;
    open_.push_back({WallCone(answer.point, reversed(answer.normal), options_.sine, options_.scale),
                     i, options_.max_thickness / 2, options_.max_thickness / 2});
  }
}

/// Shrinks a ball to a point that is in the cone and within the ball.
bool ThicknessSearch::shrink_to(Ball& ball, const Vec3& contact, WallThickness& result) const {
  const double radius = ball.cone.radius_to(contact);
  if (!(radius < kShrinks * ball.tried)) return false;
  ball.radius = ball.tried = radius;
  result.contact = contact;
  result.has_contact = true;
  return true;
}

/// Takes the nearest point to the centre of the ball that was tried. Returns whether there is a
/// further ball to try.
bool ThicknessSearch::step(Ball& ball, const ClosestPoint& answer, WallThickness& result) const {
  if (answer.status != Status::kExact) result.status = ThicknessStatus::kDegraded;
  const double depth = ball.tried - answer.lower;
  if (depth <= ball.cone.allowed_depth()) {
    if (ball.least == 0) ball.least = ball.cone.least_radius_in_empty(ball.tried);
    return false;
  }
  if (shrink_to(ball, answer.point, result)) {
    ball.least = 0;
    return true;
  }
  // What this ball hides reaches up to ball.hidden of the ball before, or there is a gap.
  const double hidden = ball.cone.hidden(depth);
  if (ball.least > 0 && ball.tried - hidden < ball.hidden) ball.least = 0;
  constexpr double kStep = 2.5;  // a smaller ball's hidden() is not greater, so that 2 suffices
  if (kStep * hidden > ball.tried / 2) {
    ball.least = 0;
    ball.tried /= 2;
  } else {
    if (ball.least == 0) ball.least = ball.tried - hidden;
    ball.hidden = hidden;
    ball.tried = kStep * hidden;
  }
  return ball.tried > WallCone::kTolerance * options_.scale;
}

/// A round: asks for the nearest point to the centre of each ball.
void ThicknessSearch::shrink(std::span<WallThickness> results) {
  centres_.clear();
  for (const Ball& ball : open_) centres_.push_back(ball.cone.centre(ball.tried));
  answers_.resize(centres_.size());
  probe_.closest_points(centres_, answers_, {.parts = kDistance});
  std::vector<Ball> still_open;
  for (std::size_t i = 0; i < open_.size(); ++i) {
    Ball& ball = open_[i];
    WallThickness& result = results[ball.index];
    if (step(ball, answers_[i], result))
      still_open.push_back(ball);
    else if (ball.least < (1 - kListedShare) * ball.radius)
      listed_.push_back(ball);
    else
      finish(ball, result);
  }
  open_ = std::move(still_open);
}

/// Lists triangles within a ball, the nearest to its centre first. Shrinks it to points of theirs.
/// Returns whether it has shrunk.
bool ThicknessSearch::shrink_by_list(Ball& ball, WallThickness& result) {
  ball.tried = ball.radius;
  bool has_shrunk = false;
  for (int round = 0; round < kMaxLists; ++round) {
    listed_radius_ = ball.radius;
    found_ = probe_.triangles_within(ball.cone.centre(ball.radius), ball.radius, list_,
                                     {.parts = kDistance | kNormal});
    bool shrinks = false;
    for (const ClosestPoint& answer : std::span(list_).first(found_.count))
      shrinks = shrink_to(ball, answer.point, result) || shrinks;
    if (!shrinks) break;
    has_shrunk = true;
  }
  return has_shrunk;
}

/// A lower bound of the radius by the planes of all triangles within the ball, 0 if not all are
/// listed.
double ThicknessSearch::least_radius_of_list(const Ball& ball) const {
  if (!found_.complete) return 0;
  double least = ball.cone.least_radius_in_empty(ball.radius);
  for (const ClosestPoint& answer : std::span(list_).first(found_.count)) {
    double of_triangle = ball.cone.least_radius_to_plane(answer.point, answer.normal);
    const double hidden = ball.cone.hidden(ball.radius - answer.lower);
    if (of_triangle > hidden) of_triangle = std::max(of_triangle, ball.radius - hidden);
    least = std::min(least, of_triangle);
  }
  return least;
}

void ThicknessSearch::list_and_finish(Ball& ball, WallThickness& result) {
  if (shrink_by_list(ball, result)) {
    ball.least = 0;
    for (int round = 0; round < kMaxRounds; ++round) {
      const Vec3 centre = ball.cone.centre(ball.tried);
      if (!step(ball, probe_.closest_point(centre, {.parts = kDistance}), result)) break;
    }
  }
  // The list is of the last ball unless it has shrunk since.
  if (ball.radius == listed_radius_) ball.least = std::max(ball.least, least_radius_of_list(ball));
  finish(ball, result);
}

void ThicknessSearch::finish(const Ball& ball, WallThickness& result) const {
  const double rounding = ball.cone.rounding();
  result.lower = std::max(0.0, 2 * (std::min(ball.least, ball.radius) - rounding));
  if (!result.has_contact) {
    result.thickness = result.upper = kInfinity;
    if (result.status != ThicknessStatus::kDegraded) result.status = ThicknessStatus::kBeyond;
    return;
  }
  result.thickness = 2 * ball.radius;
  result.upper = 2 * (ball.radius + rounding);
  const double width = 8 * (rounding + ball.cone.allowed_depth()) + kExactShare * result.upper;
  if (result.status == ThicknessStatus::kBounded && result.upper - result.lower <= width)
    result.status = ThicknessStatus::kExact;
}

}  // namespace planetree::tools
