#include "tests/oracle/interval_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace planetree::oracle {
namespace {

constexpr long double kInfinity = std::numeric_limits<long double>::infinity();

struct Long3 {
  long double x, y, z;
};

Long3 from_to(const Vec3& from, const Vec3& to) {
  return {static_cast<long double>(to.x) - from.x, static_cast<long double>(to.y) - from.y,
          static_cast<long double>(to.z) - from.z};
}

Long3 cross(const Long3& u, const Long3& v) {
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

long double squared(const Long3& u) { return u.x * u.x + u.y * u.y + u.z * u.z; }

// Relative error of extended_distance(): some hundred roundings of 2^-64, divided by the squared
// sine of the angle between the two longest edges. Infinite for slender triangles.
long double relative_error(const Corners& t) {
  const Long3 edges[3] = {from_to(t[0], t[1]), from_to(t[1], t[2]), from_to(t[2], t[0])};
  long double lengths2[3] = {squared(edges[0]), squared(edges[1]), squared(edges[2])};
  std::sort(lengths2, lengths2 + 3);
  const long double sine2 = squared(cross(edges[0], edges[1])) / (lengths2[1] * lengths2[2]);
  return sine2 > 0x1p-10L ? 0x1p-55L / sine2 : kInfinity;
}

long double outside(double lower, double upper, double at) {
  return std::max(
      {static_cast<long double>(lower) - at, static_cast<long double>(at) - upper, 0.0L});
}

// As compare_distance(). `relative` is the error of extended_distance() divided by the distance of
// the farthest corner.
int compare(const Vec3& query, const Corners& corners, long double relative, double distance) {
  long double farthest2 = 0;
  for (const Vec3& corner : corners)
    farthest2 = std::max(farthest2, squared(from_to(query, corner)));
  const long double error = relative * std::sqrt(farthest2);
  const long double difference = extended_distance(query, corners) - distance;
  if (std::fabs(difference) > error) return difference > 0 ? 1 : -1;
  const ExactSquare exact = exact_square(query, corners);
  using Integer = boost::multiprecision::cpp_int;
  // distance = digits * 2^bits, so both squares are integers after a shift.
  int bits = 0;
  const double fraction = std::frexp(distance, &bits);
  const Integer digits = static_cast<std::int64_t>(std::ldexp(fraction, 53));
  Integer left = exact.numerator, right = digits * digits * exact.denominator;
  const int shift = 2 * (bits - 53) - 2 * exact.exponent;
  (shift > 0 ? right : left) <<= static_cast<unsigned>(std::abs(shift));
  return left.compare(right);
}

}  // namespace

int compare_distance(const Vec3& query, const Corners& triangle, double distance) {
  return compare(query, triangle, relative_error(triangle), distance);
}

IntervalOracle::IntervalOracle(std::span<const Corners> triangles) : triangles_(triangles) {
  for (const Corners& t : triangles) {
    const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [y0, y1] = std::minmax({t[0].y, t[1].y, t[2].y});
    const auto [z0, z1] = std::minmax({t[0].z, t[1].z, t[2].z});
    measured_.push_back({{x0, y0, z0}, {x1, y1, z1}, relative_error(t)});
  }
}

int IntervalOracle::compare(const Vec3& query, std::size_t triangle, double distance) const {
  return oracle::compare(query, triangles_[triangle], measured_[triangle].error, distance);
}

bool IntervalOracle::none_nearer(const Vec3& query, double lower) const {
  const long double lower2 = static_cast<long double>(lower) * lower * (1 + 0x1p-50L);
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const Measured& box = measured_[i];
    const Long3 gap{outside(box.lower.x, box.upper.x, query.x),
                    outside(box.lower.y, box.upper.y, query.y),
                    outside(box.lower.z, box.upper.z, query.z)};
    if (squared(gap) <= lower2 && compare(query, i, lower) < 0) return false;
  }
  return true;
}

bool IntervalOracle::reaches(const Vec3& query, std::uint64_t triangle, double upper) const {
  return !(upper < std::numeric_limits<double>::infinity()) || compare(query, triangle, upper) <= 0;
}

}  // namespace planetree::oracle
