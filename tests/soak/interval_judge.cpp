#include "tests/soak/interval_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/oracle/nasty_models.h"
#include "tests/query/answer_bits.h"

namespace planetree::oracle {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
bool is_finite(const Vec3& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
bool is_origin(const Vec3& a) { return a.x == 0 && a.y == 0 && a.z == 0; }

bool has(const QueryOptions& options, std::uint32_t part) { return (options.parts & part) != 0; }
bool has_distance(const QueryOptions& options) { return has(options, kDistance | kNormal); }
bool has_side(const QueryOptions& options) { return has(options, kSide | kNormal); }

// Whether nothing but the region or an unknown side may degrade an answer.
bool is_unhindered(const QueryOptions& options) {
  return options.wait == Wait::kForPages && options.max_work == QueryOptions::kNoLimit;
}

std::string_view broken_numbers(const JudgedQuery& query, const ClosestPoint& a) {
  if (std::isnan(a.distance) || !std::isfinite(a.lower) || std::isnan(a.upper))
    return "a length is no number";
  if (!is_finite(a.point) || !is_finite(a.normal) || !is_finite(a.barycentric))
    return "a coordinate is not finite";
  if (!(a.lower >= 0 && a.lower < a.upper)) return "the interval is empty";
  if (std::fabs(dot(a.normal, a.normal) - 1) > 1e-12) return "the normal is not of length 1";
  if (a.triangle == kNoTriangle && !is_origin(a.barycentric)) return "no triangle, but shares";
  const bool is_bare = !has_distance(query.options) || a.status == Status::kBeyondMaxDistance;
  if (is_bare) {
    const double lower = has_distance(query.options) ? query.options.max_distance : 0;
    const bool is_empty = a.lower == lower && a.upper == kInfinity && a.distance == kInfinity &&
                          a.triangle == kNoTriangle && is_origin(a.point);
    return is_empty ? "" : "something is told that was not found";
  }
  if (a.triangle == kNoTriangle && a.distance != a.upper) return "no triangle, but a distance";
  return "";
}

// Scaling subnormal numbers may round.
bool may_round(const ClosestPoint& answer) { return answer.lower < 1e-290; }

// The answer that others are compared with.
std::string_view broken_reference(const JudgedQuery& query, const ClosestPoint&) {
  const ClosestPoint& exact = query.exact;
  if (exact.status == Status::kExact) return "";
  if (exact.status != Status::kDegraded) return "without limits, the status is another";
  const bool may_be_unknown =
      query.has_region || (has_side(query.options) && exact.side == Side::kUnknown);
  return may_be_unknown || has(query.options, kNormal) ? "" : "without limits, it is not exact";
}

std::string_view broken_interval(const JudgedQuery& query, const ClosestPoint& a) {
  if (!has_distance(query.options)) return "";
  const ClosestPoint& exact = query.exact;
  const double limit = query.options.max_distance;
  if (a.status == Status::kBeyondMaxDistance)
    return exact.upper >= limit ? "" : "there is surface within the limit";
  if (!(a.lower <= exact.upper && a.upper >= exact.lower)) return "the intervals do not meet";
  if (a.distance < exact.lower) return "a surface point is nearer than the surface";
  if (a.lower > limit) return "the surface is beyond the limit";
  if (is_unhindered(query.options) && !query.has_region && limit < kInfinity &&
      exact.lower - limit > 1e-11 * (limit + exact.lower + 4 * query.size) &&
      a.status == Status::kExact)
    return "an exact answer is beyond the limit";
  return "";
}

// Whether no face at the nearest point has area, so that none tells on which side the query is.
bool lacks_front(const QueryOptions& options, const ClosestPoint& a) {
  return options.normal_rule == NormalRule::kTowardQuery && a.normal.x == 0 && a.normal.y == 0 &&
         a.normal.z == 1;
}

std::string_view broken_status(const JudgedQuery& query, const ClosestPoint& a) {
  const QueryOptions& options = query.options;
  switch (a.status) {
    case Status::kExact:
      return bits_of(a) == bits_of(query.exact) ? "" : "an exact answer has other bits";
    case Status::kWithinError:
      if (!(a.upper - a.lower <= options.max_error)) return "the interval is wider than allowed";
      if (!(a.distance >= a.lower && a.distance <= a.upper)) return "the distance is not in it";
      if (has_side(options) && a.side != query.exact.side) return "the side is another";
      if (has_side(options) && a.side == Side::kUnknown) return "the side is unknown";
      return "";
    case Status::kDegraded:
      if (a.side != Side::kUnknown && a.side != query.exact.side) return "the side is another";
      if (is_unhindered(options) && query.exact.status == Status::kExact && !may_round(a) &&
          !lacks_front(options, a))
        return "nothing was missing";
      return "";
    case Status::kBeyondMaxDistance:
      if (!(options.max_distance < kInfinity)) return "there is no limit to be beyond";
      return a.side == Side::kUnknown || a.side == query.exact.side ? "" : "the side is another";
    default:
      return "the query is not bad";
  }
}

// Of an answer without a triangle, the normal is the direction between point and query.
std::string_view broken_direction(const JudgedQuery& query, const ClosestPoint& a) {
  if (a.status != Status::kWithinError || a.triangle != kNoTriangle) return "";
  const Vec3 way = query.at - a.point;
  const double reach = std::max({std::fabs(way.x), std::fabs(way.y), std::fabs(way.z)});
  if (!(reach > 1e-9 * query.size)) return "";
  const Vec3 direction = Vec3{way.x / reach, way.y / reach, way.z / reach};
  const double length = reach * std::sqrt(dot(direction, direction));
  if (length > a.upper * (1 + 1e-6) + 1e-9 * query.size) return "the point is farther than told";
  if (!has(query.options, kNormal)) return "";
  const double height = dot(direction, a.normal);
  if (query.options.normal_rule == NormalRule::kTowardQuery)
    return height > -1e-6 ? "" : "the normal points away from the query";
  if (a.side == Side::kOutside && height < -1e-6) return "the normal points inward";
  if (a.side == Side::kInside && height > 1e-6) return "the normal points inward";
  return "";
}

}  // namespace

std::string_view broken_rule(const JudgedQuery& query, const ClosestPoint& answer) {
  for (const auto& rule :
       {broken_reference, broken_numbers, broken_interval, broken_status, broken_direction})
    if (const std::string_view broken = rule(query, answer); !broken.empty()) return broken;
  return "";
}

}  // namespace planetree::oracle
