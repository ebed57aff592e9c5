#include "query/answer/model_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "query/answer/missing_surface.h"
#include "query/answer/query_context.h"

namespace planetree::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
double largest(const octree::Point& vector) { return vector.cwiseAbs().maxCoeff(); }

// The exponent of the largest component of a direction.
int exponent_of(const Vec3& direction) {
  return std::ilogb(
      std::max({std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)}));
}

}  // namespace

bool is_valid(const Ray& ray) {
  const Vec3& d = ray.direction;
  return is_finite(ray.origin) && is_finite(d) && (d.x != 0 || d.y != 0 || d.z != 0) &&
         ray.t_min >= 0 && std::isfinite(ray.t_min) && ray.t_max >= ray.t_min;
}
bool is_valid(const Sweep& sweep) {
  return is_finite(sweep.from) && is_finite(sweep.to) && sweep.radius >= 0 &&
         std::isfinite(sweep.radius);
}

ModelLine::ModelLine(const Scale& scale, const Ray& ray) {
  const int exponent = exponent_of(ray.direction);
  const auto unit = [exponent](double value) { return std::ldexp(value, -exponent); };
  line_ = {scale.in(ray.origin),
           {unit(ray.direction.x), unit(ray.direction.y), unit(ray.direction.z)},
           octree::Point::Zero()};
  exponent_ = exponent + scale.exponent();
  given_ = {ray.t_min, ray.t_max};
  range_ = {std::ldexp(ray.t_min, exponent_), std::ldexp(ray.t_max, exponent_)};
  speed_ = line_.head.norm() * (1 + octree::kNormRounding);
  is_far_ = query::is_far(line_.origin) || !std::isfinite(range_.lower);
}

ModelLine::ModelLine(const Scale& scale, const Sweep& sweep)
    : line_{scale.in(sweep.from), scale.in(sweep.to), scale.in(sweep.from)},
      given_{0, 1},
      range_{0, 1},
      speed_(line_.direction().norm() * (1 + octree::kNormRounding)),
      is_far_(query::is_far(line_.origin) || query::is_far(line_.head)) {}

bool ModelLine::end_after(double length) {
  const double end = position_after(range_.lower, length);
  if (!(end < range_.upper)) return false;
  range_.upper = end;
  return true;
}

// The box grows by more than positions err.
octree::LineRange ModelLine::within(const octree::Point& lower, const octree::Point& upper,
                                    double margin) const {
  const octree::Point way = line_.direction();
  const double grown =
      (margin + largest(upper - lower) + largest(line_.origin - lower)) * octree::kClipMargin +
      margin;
  octree::LineRange found = range_;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double first = lower[axis] - grown - line_.origin[axis];
    const double last = upper[axis] + grown - line_.origin[axis];
    if (way[axis] == 0) {
      if (first > 0 || last < 0) return {1, 0};
      continue;
    }
    const double entry = (way[axis] > 0 ? first : last) / way[axis];
    const double exit = (way[axis] > 0 ? last : first) / way[axis];
    found.lower = std::max(found.lower, entry);
    found.upper = std::min(found.upper, exit);
  }
  return found;
}

double ModelLine::error_at(double position) const {
  return octree::kPositionRounding * (largest(line_.origin) + position * speed_);
}
double ModelLine::length_between(double from, double to) const {
  return (to - from) * speed_ * (1 + octree::kNormRounding);
}
double ModelLine::position_after(double from, double length) const {
  if (!(length > 0)) return from;
  return from + length / speed_ * (1 - octree::kNormRounding);
}

// With the least directions the ends of the range are rounded in the model frame.
double ModelLine::out(double position) const {
  return std::clamp(std::ldexp(position, -exponent_), given_.lower, given_.upper);
}
double ModelLine::out_below(double position) const {
  const double value = std::ldexp(position, -exponent_);
  return value < std::numeric_limits<double>::min() ? std::max(0.0, std::nextafter(value, 0.0))
                                                    : value;
}
double ModelLine::out_above(double position) const {
  const double value = std::ldexp(position, -exponent_);
  return value < std::numeric_limits<double>::min() ? std::nextafter(value, kInfinity) : value;
}

// The region is convex, so that the distance to its walls is least at an end of the way.
double clear_length(const ModelGeometry& model, const ModelLine& way, double end, double margin) {
  if (!model.region.has_walls()) return kInfinity;
  const double begin = way.range().lower;
  const double at_start = clearance(model, way.at(begin), false) - way.error_at(begin) - margin;
  if (end < kInfinity && at_start > 0 &&
      clearance(model, way.at(end), false) > margin + way.error_at(end))
    return kInfinity;
  return std::max(0.0, at_start);
}

}  // namespace planetree::query
