#include "octree/geometry/startup_check.h"

#include <cmath>
#include <limits>

#include "octree/geometry/predicates.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

/// Returns `value` in a way that the compiler cannot evaluate at compile time.
template <class T>
T hide_from_compiler(T value) {
  const volatile T hidden = value;
  return hidden;
}

/// Checks that each operation rounds once, to nearest, ties to even, to its own type.
template <class T>
const char* rounding_fault() {
  constexpr T kUlp = std::numeric_limits<T>::epsilon();
  const T one = hide_from_compiler(T(1)), half = hide_from_compiler(kUlp / 2);
  if (one + half != 1 || -one - half != -1 || one + half * 3 != 1 + 2 * kUlp ||
      one + (half + half * hide_from_compiler(kUlp)) != 1 + kUlp)
    return "results are not rounded to nearest, once";
  const T near_one = one + hide_from_compiler(kUlp) * 4;
  if (near_one * near_one - (one + hide_from_compiler(kUlp) * 8) != 0)
    return "a product and a sum are fused into one operation";
  const T large = hide_from_compiler(2 / kUlp);
  if ((large + one) - large != 0 || (one + large) - large != 0)
    return "sums are reordered as if they were exact";
  if (std::sqrt(hide_from_compiler(T(1) + 2 * kUlp)) != 1 + kUlp)
    return "square roots are not right";
  return nullptr;
}

template <class T>
const char* range_fault() {
  const T least = hide_from_compiler(std::numeric_limits<T>::min());
  const T subnormal = hide_from_compiler(std::numeric_limits<T>::denorm_min());
  if (!(least / 2 > 0) || !(subnormal > 0) ||
      least - least * hide_from_compiler(T(0.75)) != least / 4)
    return "subnormal numbers are taken for zero";
  const T infinity = hide_from_compiler(std::numeric_limits<T>::infinity());
  const T nothing = infinity - infinity;
  if (nothing == nothing || !(infinity > std::numeric_limits<T>::max()))
    return "infinities and NaN are not recognised";
  return nullptr;
}

/// Tests points beside the line x = y, which is given by points so far away that differences in
/// double lose bits. A third point above turns the line into a plane.
///
/// source  Kettner et al. 2008, "Classroom examples of robustness problems in geometric
///         computations"
const char* orientation_fault(const TestedPredicates& tested) {
  const Point a(12, 12, 0), b(24, 24, 0), above(12, 12, 1);
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y) {
      const Point d(0.5 + x * 0x1p-53, 0.5 + y * 0x1p-53, 0);
      const int sign = (x > y) - (x < y);
      if (tested.orientation(a, b, above, d) != sign || tested.orientation(b, a, above, d) != -sign)
        return "points are on the wrong side of a plane";
      if (tested.normal_sign(a, b, d, 2) != -sign) return "a triangle faces the wrong way";
    }
  constexpr double kTiny = 0x1p-1074;
  const Point origin(0, 0, 0), x(0x1p300, 0, 0), y(0, kTiny, 0);
  if (tested.orientation(origin, x, y, {0, 0, kTiny}) != 1 ||
      tested.orientation(origin, x, y, {0, 0, -kTiny}) != -1 ||
      tested.orientation(origin, x, y, {0x1p300, 0x1p300, 0}) != 0)
    return "points are on the wrong side of a plane where products underflow";
  return nullptr;
}

const char* contact_fault(const TestedPredicates& tested) {
  const Triangle triangle{Point(0, 0, 0), Point(0.75, 0, 0.75), Point(0, 0.75, 0.75)};
  const double up = 0.5 + 0x1p-53;
  if (!tested.lies_on({0.25, 0.25, 0.5}, triangle) || !tested.lies_on(triangle[2], triangle) ||
      tested.lies_on({0.25, 0.25, up}, triangle) || tested.lies_on({0.5, 0.5, 1}, triangle))
    return "points on a triangle are not distinguished from points next to it";
  return nullptr;
}

}  // namespace

TestedPredicates TestedPredicates::library() noexcept {
  return {[](const Point& a, const Point& b, const Point& c, const Point& d) noexcept {
            return octree::orientation(a, b, c, d);
          },
          [](const Point& a, const Point& b, const Point& c, unsigned axis) noexcept {
            return octree::normal_sign(a, b, c, axis);
          },
          [](const Point& point, const Triangle& triangle) noexcept {
            return octree::lies_on(point, triangle);
          }};
}

const char* startup_check(const TestedPredicates& predicates) noexcept {
  if (const char* fault = rounding_fault<double>()) return fault;
  if (const char* fault = rounding_fault<float>()) return fault;
  if (const char* fault = range_fault<double>()) return fault;
  if (const char* fault = range_fault<float>()) return fault;
  if (const char* fault = orientation_fault(predicates)) return fault;
  return contact_fault(predicates);
}

Result<void> check_arithmetic() noexcept {
  const char* const fault = startup_check();
  if (!fault) return {};
  return make_error(ErrorCode::kUnsupported, Error::kNowhere, Error::kNowhere,
                    "this build computes otherwise than it must: %s; compile without "
                    "-ffast-math, -ffp-contract and -mfpmath=387",
                    fault);
}

}  // namespace planetree::octree
