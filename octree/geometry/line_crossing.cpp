#include "octree/geometry/line_crossing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/work_limit.h"

namespace planetree::octree {
namespace {

// A sum of six products of three differences, with a bound on its error.
struct Determinant {
  double value, error;
};
Determinant determinant(const Point& u, const Point& v, const Point& w) {
  const double xy = v.x() * w.y(), yx = v.y() * w.x();
  const double yz = v.y() * w.z(), zy = v.z() * w.y();
  const double zx = v.z() * w.x(), xz = v.x() * w.z();
  const double permanent = std::fabs(u.x()) * (std::fabs(yz) + std::fabs(zy)) +
                           std::fabs(u.y()) * (std::fabs(zx) + std::fabs(xz)) +
                           std::fabs(u.z()) * (std::fabs(xy) + std::fabs(yx));
  const double largest =
      std::max({u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff(), w.cwiseAbs().maxCoeff()});
  return {u.x() * (yz - zy) + u.y() * (zx - xz) + u.z() * (xy - yx),
          kOrientationFilter * permanent + kFlushLoss * (1 + largest) * (1 + largest)};
}
int certain_sign(const Determinant& found) {
  return std::fabs(found.value) > found.error ? (found.value > 0 ? 1 : -1) : 0;
}

int compare(double left, double right) { return left < right ? -1 : left > right ? 1 : 0; }

// The side on which the perturbed line passes the edge from b to a. The first term that is not zero
// decides. In order of decreasing magnitude, with D the direction and e = a - b, the terms are
//
//     (o - b) . (D x e),
//     steps of the origin:     D x e,
//     steps of the direction:  e x (o - b),
//     products:                (step of D) . (e x step of o).
int passing_side(const Line& line, const Point& a, const Point& b, WorkLimit* limit) {
  int side = certain_sign(determinant(line.origin - b, line.direction(), a - b));
  if (side == 0) side = exact_line_side(line, a, b, limit);
  for (unsigned axis = 0; side == 0 && axis < 3; ++axis)
    side = exact_turn_sign(line, a, b, axis, limit);
  if (side != 0) return side;
  const int e[3] = {compare(a.x(), b.x()), compare(a.y(), b.y()), compare(a.z(), b.z())};
  const int products[3][2] = {{-e[2], e[1]}, {e[2], -e[0]}, {-e[1], e[0]}};
  for (unsigned axis = 0; side == 0 && axis < 3; ++axis) {
    side = normal_sign(b, a, line.origin, axis, limit);
    for (const int product : products[axis])
      if (side == 0) side = product;
  }
  return side;
}

bool is_before(const Point& left, const Point& right) {
  return std::lexicographical_compare(left.data(), left.data() + 3, right.data(), right.data() + 3);
}

// A position in double, with a bound on its error; the error is infinite where double tells little.
LineCrossing position_of(const Line& line, const Triangle& triangle) {
  const Point u = triangle[1] - triangle[0], v = triangle[2] - triangle[0];
  const Determinant above = determinant(u, v, triangle[0] - line.origin);
  const Determinant below = determinant(u, v, line.direction());
  LineCrossing found;
  found.error = std::numeric_limits<double>::infinity();
  const double least = std::fabs(below.value) - below.error;
  if (!(least > 0)) return found;
  found.t = above.value / below.value;
  const double error =
      (above.error + std::fabs(found.t) * below.error) / least * kPositionInflation +
      std::fabs(found.t) * kRatioRounding;
  const double way =
      (triangle[0] - line.origin).cwiseAbs().maxCoeff() / line.direction().cwiseAbs().maxCoeff();
  if (error <= kMaxPositionError * (way + std::fabs(found.t))) found.error = error;
  return found;
}

}  // namespace

LineCrossing cross(const Line& line, const LineRange& range, const Triangle& triangle,
                   WorkLimit* limit) noexcept {
  const auto& [a, b, c] = triangle;
  if (line.head == line.tail) return {lies_on(line.origin, triangle, limit) ? 1 : 0, 0, 0};
  const int sign = passing_side(line, a, b, limit);
  if (sign == 0 || passing_side(line, b, c, limit) != sign ||
      passing_side(line, c, a, limit) != sign)
    return {};
  Triangle sorted = triangle;
  std::sort(sorted.begin(), sorted.end(), is_before);
  LineCrossing found = position_of(line, sorted);
  const auto is_unsure = [&](double end) { return std::fabs(found.t - end) <= found.error; };
  if (is_unsure(range.lower) || is_unsure(range.upper)) {
    found.t = exact_position(line, sorted, limit);
    found.error = std::fabs(found.t) * kRatioRounding + kMinPosition;
  }
  if (!(found.t >= range.lower && found.t <= range.upper)) return {};
  found.sign = sign;
  return found;
}

}  // namespace planetree::octree
