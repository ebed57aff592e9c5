#include "octree/nearest/front_side.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/Geometry>

#include "octree/geometry/angles.h"
#include "octree/geometry/error_bounds.h"
#include "octree/geometry/predicates.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/wide_numbers.h"
#include "octree/geometry/work_limit.h"
#include "octree/traversal/tree_walk.h"

namespace planetree::octree {
namespace {

Front front_of(int sign) {
  return sign > 0 ? Front::kInFront : sign < 0 ? Front::kBehind : Front::kLevel;
}

Vector3<Quad> wide_way(const Point& from, const Point& to) {
  return {wide<Quad>(to.x()) - wide<Quad>(from.x()), wide<Quad>(to.y()) - wide<Quad>(from.y()),
          wide<Quad>(to.z()) - wide<Quad>(from.z())};
}

struct SineCosine {
  Quad sine, cosine;
};

// Returns sine and cosine of an angle from 0 to pi, right to 2^-104: terms of at most pi^3 / 6 sum
// to about 23, and the first term left out is below 2^-113.
SineCosine sine_and_cosine(double angle) {
  constexpr int kTerms = 44;
  const Quad x = wide<Quad>(angle);
  SineCosine sums{0, 1};
  Quad term = 1;
  for (int power = 1; power <= kTerms; ++power) {
    term = term * x / power;
    Quad& sum = power % 2 == 1 ? sums.sine : sums.cosine;
    if (power % 4 < 2)
      sum += term;
    else
      sum -= term;
  }
  return sums;
}

// Returns the angle of given sine and cosine, 0 to pi, right to 2^-100. `near` is right to 2^-40:
// the sine of what it is off by is that of the difference of both angles.
Quad refined_angle(double near, const SineCosine& of) {
  const SineCosine nearly = sine_and_cosine(near);
  const Quad off = of.sine * nearly.cosine - of.cosine * nearly.sine;
  return wide<Quad>(near) + off + off * off * off / 6;
}

}  // namespace

void FrontSide::begin(bool by_angle) {
  by_angle_ = by_angle;
  has_front_ = has_behind_ = has_level_ = false;
  first_index_ = kNoTriangle;
  first_side_ = 0;
  sum_ = error_ = 0;
  is_mild_ = true;
  count_ = 0;
}

void FrontSide::add(const Triangle& face, unsigned corner, std::uint64_t index, double weight,
                    WorkLimit& limit) {
  const Point &from = face[corner], &next = face[(corner + 1) % 3], &last = face[(corner + 2) % 3];
  const int side = orientation(from, next, last, query_, &limit);
  has_front_ = has_front_ || side > 0;
  has_behind_ = has_behind_ || side < 0;
  has_level_ = has_level_ || side == 0;
  if (index < first_index_) {
    first_index_ = index;
    first_side_ = side;
  }
  if (side == 0) return;
  add_in_double(next - from, last - from, query_ - from, weight);
  if (count_ < kMax) faces_[count_] = {index, corner, from, next, last};
  ++count_;
}

// With s the sine at the corner and w the way to the query: a cross product errs by 16 u |u| |v|,
// its direction by 16 u / s, the height by |w| (64 u / s + 32 u), and the angle, at most pi, by
// 2^-49. A unit is far below the rest.
void FrontSide::add_in_double(const Point& u, const Point& v, const Point& way, double weight) {
  const auto is_mild = [](double square) {
    return square > kMinAngleLength2 && square < kMaxAngleLength2;
  };
  const double u2 = u.squaredNorm(), v2 = v.squaredNorm(), way2 = way.squaredNorm();
  is_mild_ = is_mild_ && is_mild(u2) && is_mild(v2) && is_mild(way2);
  if (!is_mild_) return;
  const Point normal = u.cross(v);
  const double area2 = normal.squaredNorm();
  is_mild_ = area2 > kThinFaceSine2 * u2 * v2;
  if (!is_mild_) return;
  const double height = way.dot(normal) / std::sqrt(area2 * way2);
  sum_ += static_cast<std::int64_t>(weight * height / kUnit);
  error_ += static_cast<std::int64_t>((kFrontSineError * std::sqrt(u2 * v2 / area2) + kFrontError) /
                                      kUnit);
}

Front FrontSide::front(bool cancelled, WorkLimit& limit) {
  if (limit.exceeded() || !(has_front_ || has_behind_ || has_level_)) return Front::kUnknown;
  if (cancelled) return front_of(first_side_);
  if (!has_behind_) return front_of(has_front_ ? 1 : 0);
  if (!has_front_) return front_of(-1);
  if (is_mild_ && sum_ > error_) return Front::kInFront;
  if (is_mild_ && -sum_ > error_) return Front::kBehind;
  const unsigned units = by_angle_ ? WorkUnits::kWideCornerHeight : WorkUnits::kWideHeight;
  if (count_ > kMax || !limit.try_take(count_ * units)) return Front::kUnknown;
  std::sort(faces_.begin(), faces_.begin() + static_cast<std::ptrdiff_t>(count_),
            [](const Face& a, const Face& b) {
              return a.index != b.index ? a.index < b.index : a.corner < b.corner;
            });
  return sum_in_quad();
}

// The same bounds with 113 bits; sine, cosine and angle are right to 2^-100.
Front FrontSide::sum_in_quad() const {
  const Vector3<Quad> way = wide_way(faces_[0].from, query_);
  const Quad distance = sqrt(dot(way, way));
  Quad value = 0, error = 0;
  for (const Face& face : std::span(faces_).first(count_)) {
    const Vector3<Quad> u = wide_way(face.from, face.next), v = wide_way(face.from, face.last);
    const Vector3<Quad> normal = cross(u, v);
    const Quad area = sqrt(dot(normal, normal)), sides = sqrt(dot(u, u) * dot(v, v));
    if (!(area > 0) || !(sides > 0)) return Front::kUnknown;
    const SineCosine corner{area / sides, dot(u, v) / sides};
    Quad weight = 1;
    if (by_angle_)
      weight = refined_angle(angle_of(static_cast<double>(corner.cosine),
                                      std::max(0.0, static_cast<double>(corner.sine))),
                             corner);
    value += weight * (dot(way, normal) / area);
    error += distance * (ldexp(Quad(1), kWideFrontSineErrorBits) / corner.sine +
                         ldexp(Quad(1), kWideFrontErrorBits));
  }
  const Quad magnitude = value < 0 ? Quad(-value) : value;
  return magnitude > error ? front_of(value > 0 ? 1 : -1) : Front::kUnknown;
}

Front front_of_all_within(const TreeInfo& tree, const Point& query, double reach,
                          std::uint64_t max_work, const PageReader& pages,
                          TraversalStats& work) noexcept {
  // Rounding of the box's sides is far below this share of coordinates and reach.
  const double rim = kNormRounding * (query.cwiseAbs().maxCoeff() + reach) + kUnresolvedLength;
  const Point lower = query.array() - (reach + rim), upper = query.array() + (reach + rim);
  bool in_front = false, behind = false, other = false, on_surface = false;
  WorkLimit limit(work.units, max_work);
  const auto look_at = [&](const Triangle& triangle) {
    if ((greatest_corner(triangle).array() < lower.array()).any() ||
        (least_corner(triangle).array() > upper.array()).any())
      return;
    if (!limit.take()) return;
    const auto& [a, b, c] = triangle;
    const int side = orientation(a, b, c, query, &limit);
    in_front = in_front || side > 0;
    behind = behind || side < 0;
    if (side != 0) return;
    on_surface = on_surface || lies_on(query, triangle, &limit);
    for (unsigned axis = 0; axis < 3; ++axis)
      other = other || normal_sign(a, b, c, axis, &limit) != 0;
  };
  BoxWalk walk(tree, lower, upper, pages, work);
  const bool complete = walk.run(limit.left(), [&](const BlockView& block, std::uint32_t) {
    for (unsigned i = 0; i < block.triangle_count() && !limit.exceeded(); ++i)
      look_at(block.triangle(i));
  });
  if (limit.exceeded()) return Front::kUnknown;
  // One triangle proves this, whatever was missing.
  if (on_surface) return Front::kOnSurface;
  if (!complete || other || in_front == behind) return Front::kUnknown;
  return in_front ? Front::kInFront : Front::kBehind;
}

}  // namespace planetree::octree
