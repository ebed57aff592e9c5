#include "query/answer/first_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/moving_ball.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/work_limit.h"
#include "octree/nearest/feature_normal.h"
#include "octree/nearest/interval_ends.h"
#include "octree/nearest/near_triangles.h"
#include "query/answer/line_hits.h"
#include "query/answer/model_line.h"

namespace planetree::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A motion is long if it exceeds one of these lengths. Shorter ones of a device take a tenth less
// instructions without that search.
constexpr double kShortInRadii = 4, kShortInDiagonals = 0x1p-4;
// Of the search along a long way, as a share of the radius: a gain below which it ends.
constexpr double kMinFreeGain = 0x1p-8;

// The triangle that a moving ball touches first.
class FirstTouched final : public octree::NearTriangleSink {
 public:
  /// range  of t: the ball is free before `lower`; its motion ends at `upper`
  FirstTouched(const octree::MovingBall& ball, const octree::LineRange& range,
               octree::WorkLimit& limit)
      : ball_(ball), range_(range), limit_(limit) {}

  double reach() const noexcept override {
    // At the start the nearest triangle counts.
    if (upper_ == 0) return distance_;
    return (ball_.radius() + (latest() - range_.lower) * ball_.length()) *
               (1 + octree::kNormRounding) +
           2 * ball_.position_error();
  }
  void take(const octree::TriangleResult& result, const octree::Triangle& corners,
            std::uint64_t index) noexcept override {
    const double distance = std::sqrt(result.value.squared);
    if (is_too_late(distance, result.value.error)) return;
    octree::NearestOnTriangle nearest;
    locate(corners, result, nearest);
    if (ball_.is_free_until(corners, range_.lower, nearest, latest())) return;
    const octree::ContactTime time = ball_.first_touch(corners, latest(), limit_);
    if (time.lower > latest()) return;
    if (limit_.exceeded()) refused_ = std::min(refused_, time.lower);
    upper_ = std::min(upper_, time.upper);
    if (index_ != kNoTriangle && !is_before(time.lower, distance, index)) return;
    lower_ = time.lower;
    distance_ = distance;
    index_ = index;
    corners_ = corners;
  }

  bool found() const { return index_ != kNoTriangle; }
  double lower() const { return lower_; }
  double upper() const { return upper_; }
  /// Time before which no triangle was left out because work lacked.
  double refused() const { return refused_; }
  std::uint64_t triangle() const { return index_; }
  const octree::Triangle& corners() const { return corners_; }
  /// Time after which no contact is wanted.
  double latest() const { return std::min(range_.upper, upper_); }

 private:
  // Whether the ball cannot reach a triangle in time that is so far from its start, not even within
  // the uncertainty at which first_touch() stops.
  bool is_too_late(double distance, double error) const {
    const double gap = distance - 8 * (error + ball_.position_error()) - ball_.radius();
    return gap * (1 - octree::kNormRounding) > (latest() - range_.lower) * ball_.length();
  }
  bool is_before(double lower, double distance, std::uint64_t index) const {
    if (lower != lower_) return lower < lower_;
    if (lower == 0 && range_.lower == 0 && distance != distance_) return distance < distance_;
    return index < index_;
  }

  const octree::MovingBall& ball_;
  const octree::LineRange range_;
  octree::WorkLimit& limit_;
  double lower_ = kInfinity, upper_ = kInfinity, refused_ = kInfinity;
  double distance_ = kInfinity;  // of the kept triangle from the start
  std::uint64_t index_ = kNoTriangle;
  octree::Triangle corners_;
};

// Returns the direction from a contact to the centre or, where they coincide, the triangle's normal
// against the motion.
octree::Point normal_at(const octree::Point& centre, const octree::Point& contact,
                        const octree::Triangle& corners, const octree::Point& way) {
  const octree::Point toward = centre - contact;
  const double length = toward.norm();
  if (length > octree::kMinDirectionShare * contact.cwiseAbs().maxCoeff()) return toward / length;
  octree::Point normal(0, 0, 1);
  double area2 = 0;
  octree::face_normal(corners, normal, area2);
  return normal.dot(way) > 0 ? octree::Point(-normal) : normal;
}

// Describes the contact of a ball whose centre is at `centre` with a triangle.
void describe(const Scale& scale, const octree::Point& centre, double position_error,
              const octree::Triangle& corners, std::uint64_t index, const octree::Point& way,
              ClosestPoint& answer) {
  const octree::NearestOnTriangle nearest = octree::nearest_on_triangle(centre, corners);
  const double distance = std::sqrt(nearest.value.squared);
  const double error = nearest.value.error + position_error;
  answer.distance = scale.out(distance);
  answer.lower = scale.out_below(octree::lower_end(distance - error));
  answer.upper = scale.out_above(octree::upper_end(distance + error));
  if (!(answer.upper > answer.lower)) answer.upper = std::nextafter(answer.lower, kInfinity);
  answer.point = scale.out(nearest.point);
  answer.triangle = index;
  answer.barycentric = {nearest.barycentric[0], nearest.barycentric[1], nearest.barycentric[2]};
  answer.feature = nearest.feature;
  const octree::Point normal = normal_at(centre, nearest.point, corners, way);
  answer.normal = {normal.x(), normal.y(), normal.z()};
}

// Sets the times of an answer and its status.
//
// unread  a time before which nothing that was not read is touched; infinity if all was read that
//         matters
// end     end of the motion; before 1 if it is shortened
void set_times(double t, double lower, double upper, double unread, double end,
               FirstContact& answer) {
  const bool is_degraded = unread < kInfinity;
  const bool is_found = t < kInfinity;
  answer.t = t;
  answer.t_lower = std::min(lower, unread);
  answer.t_upper = upper;
  answer.free = !is_found && !is_degraded && end == 1;
  if (!is_found && end < 1) answer.t_lower = std::min(answer.t_lower, end);
  answer.status = is_degraded            ? Status::kDegraded
                  : !is_found && end < 1 ? Status::kBeyondMaxDistance
                                         : Status::kExact;
  answer.at.status = answer.status;
}

// A ball of radius 0.
FirstContact contact_of_point(const QueryContext& context, const ModelLine& way,
                              const QueryOptions& options) {
  RayHit hit;
  const LineHits found = find_hits(context, way, false, options, {&hit, 1});
  FirstContact answer;
  if (found.found.count > 0) {
    ClosestPoint& at = answer.at;
    at.lower = 0;
    at.distance = 0;
    at.upper = context.model.scale.out_above(
        octree::upper_end(2 * way.error_at(way.range().upper) + octree::kUnresolvedLength));
    at.point = hit.point;
    at.triangle = hit.triangle;
    at.barycentric = hit.barycentric;
    const int zeros = (hit.barycentric.x == 0 ? 1 : 0) + (hit.barycentric.y == 0 ? 1 : 0) +
                      (hit.barycentric.z == 0 ? 1 : 0);
    at.feature = zeros == 0 ? Feature::kFace : zeros == 1 ? Feature::kEdge : Feature::kVertex;
    at.normal = hit.entering ? hit.normal : Vec3{-hit.normal.x, -hit.normal.y, -hit.normal.z};
  }
  const double upper = found.upper < kInfinity ? std::min(1.0, found.upper) : kInfinity;
  set_times(hit.t, found.lower, upper, found.is_degraded ? found.lower : kInfinity,
            way.range().upper, answer);
  return answer;
}

// Returns a position up to which a ball is free, at most the end of `range`: that which nearest
// points prove. With it, the search for contacts need not look through all that is as near to the
// start as the contact.
double free_until(const QueryContext& context, const octree::MovingBall& ball,
                  const octree::LineRange& range, std::uint64_t work_left) {
  constexpr int kMaxSteps = 12;
  double until = range.lower;
  const std::uint64_t end = context.work.units + work_left / 2;
  for (int i = 0; i < kMaxSteps && until < range.upper && context.work.units < end; ++i) {
    octree::NearestLimits limits;
    limits.field = &context.model.field;
    limits.max_distance = ball.radius() + (range.upper - until) * ball.length();
    limits.max_work = static_cast<std::uint32_t>(std::min<std::uint64_t>(
        end - context.work.units, std::numeric_limits<std::uint32_t>::max()));
    octree::CoherenceCache* const cache =
        i == 0 && context.coherence.is_on ? &context.coherence.nearest : nullptr;
    const octree::NearestAnswer nearest = octree::nearest(
        context.model.tree, ball.at(until), limits, context.pages, context.work, cache);
    const double gap = nearest.lower - ball.position_error() - ball.radius();
    if (!(gap > 0)) break;
    until = std::min(range.upper, until + gap / ball.length() * (1 - octree::kNormRounding));
    if (gap < ball.radius() * kMinFreeGain) break;
  }
  return until;
}

FirstContact contact_of_ball(const QueryContext& context, const ModelLine& way, double radius,
                             const QueryOptions& options) {
  const ModelGeometry& model = context.model;
  octree::WorkLimit limit(context.work.units, max_units(options));
  const octree::MovingBall ball(way.line().origin, way.line().head, radius);
  octree::LineRange range = way.within(model.tree.box_lower, model.tree.box_upper, radius);
  // A short motion stays within the ball about its start that the search looks through anyway.
  const bool is_short =
      ball.length() < std::min(kShortInRadii * radius, kShortInDiagonals * model.diagonal);
  if (!is_short && range.lower <= range.upper)
    range.lower = free_until(context, ball, range, limit.left());
  FirstTouched touched(ball, range, limit);
  double unread = kInfinity;
  if (range.lower <= range.upper) {
    const octree::Point start = ball.at(range.lower);
    const octree::Corridor corridor{start, ball.at(range.upper), radius + ball.position_error()};
    const double distance = near_triangles(model.tree, start, touched, limit, context.pages,
                                           context.work, is_short ? nullptr : &corridor);
    if (distance < kInfinity)
      unread = way.position_after(range.lower, distance - radius - ball.position_error());
  }
  unread = std::min(unread, touched.refused());
  const double end = touched.upper() < range.upper ? touched.upper() : way.range().upper;
  const double clear = clear_length(model, way, end, radius);
  if (clear < kInfinity) unread = std::min(unread, way.position_after(0, clear));
  if (unread > end) unread = kInfinity;

  FirstContact answer;
  if (touched.found()) {
    limit.take_some(octree::WorkUnits::kDescription);
    describe(model.scale, ball.at(touched.lower()), ball.position_error(), touched.corners(),
             touched.triangle(), ball.way(), answer.at);
  }
  set_times(touched.lower(), touched.lower(), touched.upper(), unread, way.range().upper, answer);
  return answer;
}

}  // namespace

FirstContact first_contact(const QueryContext& context, const Sweep& sweep,
                           const QueryOptions& options, bool& is_degraded) noexcept {
  const Scale& scale = context.model.scale;
  ModelLine way(scale, sweep);
  way.end_after(scale.in(options.max_distance));
  const double radius = scale.in(sweep.radius);
  FirstContact answer;
  if (way.is_far() || radius > octree::kMaxQueryCoordinate)
    answer.status = answer.at.status = Status::kDegraded;
  else
    answer = radius > 0 ? contact_of_ball(context, way, radius, options)
                        : contact_of_point(context, way, options);
  is_degraded = answer.status == Status::kDegraded;
  return answer;
}

}  // namespace planetree::query
