#include "tests/differential/answer_checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>

#include "octree/geometry/triangle_distance.h"
#include "octree/geometry/work_limit.h"
#include "octree/nearest/nearest.h"
#include "tests/oracle/pseudo_normal.h"
#include "tests/oracle/winding.h"
#include "tests/query/answer_bits.h"

namespace planetree::oracle {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string words(const Vec3& query, const QueryOptions& options, const ClosestPoint& answer) {
  char line[512];
  std::snprintf(line, sizeof line,
                "query %a %a %a (%g %g %g), max_error %g max_distance %g max_work %u: "
                "distance %.17g in [%.17g, %.17g] triangle %lld status %d",
                query.x, query.y, query.z, query.x, query.y, query.z, options.max_error,
                options.max_distance, options.max_work, answer.distance, answer.lower, answer.upper,
                static_cast<long long>(answer.triangle), static_cast<int>(answer.status));
  return line;
}

octree::Point in_frame(const Vec3& p, int exponent) {
  return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
}

octree::Triangle in_frame(const Corners& t, int exponent) {
  return {in_frame(t[0], exponent), in_frame(t[1], exponent), in_frame(t[2], exponent)};
}

void expect_finite(const ClosestPoint& answer) {
  const double numbers[] = {answer.distance,      answer.lower,         answer.upper,
                            answer.point.x,       answer.point.y,       answer.point.z,
                            answer.barycentric.x, answer.barycentric.y, answer.barycentric.z};
  for (const double number : numbers) EXPECT_TRUE(std::isfinite(number));
}

// The interval holds the true distance and, unless the answer is degraded, the distance found.
void expect_interval_holds(const ClosestPoint& answer, const Wide& truth) {
  EXPECT_LE(0, answer.lower);
  EXPECT_LT(answer.lower, answer.upper);
  EXPECT_LE(answer.lower, answer.distance);
  if (answer.status != Status::kDegraded) {
    EXPECT_LE(answer.distance, answer.upper);
  }
  EXPECT_LE(Wide(answer.lower), truth) << "by " << static_cast<double>(Wide(answer.lower) - truth);
  if (std::isfinite(answer.upper)) {
    EXPECT_LE(truth, Wide(answer.upper))
        << "by " << static_cast<double>(truth - Wide(answer.upper));
  }
}

// The triangle is the least by (value, index), and the distance follows from its value.
void expect_least(const BuiltModel& model, const Vec3& query, const ClosestPoint& answer) {
  const octree::Point point = in_frame(query, model.scale_exponent());
  std::uint64_t least = 0;
  double squared = kInfinity;
  for (std::size_t i = 0; i < model.triangles().size(); ++i) {
    const double value =
        octree::triangle_value(point, in_frame(model.triangles()[i], model.scale_exponent()))
            .squared;
    if (value < squared) {
      squared = value;
      least = i;
    }
  }
  EXPECT_EQ(answer.triangle, least);
  const double distance = std::ldexp(std::sqrt(squared), -model.scale_exponent());
  if (distance >= std::numeric_limits<double>::min()) {
    EXPECT_EQ(answer.distance, distance);
  }
}

Wide gap(const Vec3& a, const Vec3& b) {
  const Wide x = Wide(a.x) - Wide(b.x), y = Wide(a.y) - Wide(b.y), z = Wide(a.z) - Wide(b.z);
  return sqrt(x * x + y * y + z * z);
}

double largest_coordinate(const Corners& triangle) {
  double largest = 0;
  for (const Vec3& p : triangle)
    largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  return largest;
}

// `point` lies on the triangle at the barycentric coordinates, and its distance is within the
// interval, all up to a few roundings of the coordinates.
void expect_on_triangle(const Corners& t, const Vec3& query, const ClosestPoint& answer) {
  const Vec3& b = answer.barycentric;
  EXPECT_NEAR(b.x + b.y + b.z, 1, 4e-16);
  EXPECT_GE(std::min({b.x, b.y, b.z}), 0);
  const int corners = (b.x > 0) + (b.y > 0) + (b.z > 0);
  EXPECT_EQ(corners, answer.feature == Feature::kFace   ? 3
                     : answer.feature == Feature::kEdge ? 2
                                                        : 1);
  const Wide rounding = Wide(largest_coordinate(t)) * Wide(0x1p-48) + Wide(0x1p-1070);
  const Wide u(b.x), v(b.y), w(b.z);
  const Vec3 at{static_cast<double>(u * Wide(t[0].x) + v * Wide(t[1].x) + w * Wide(t[2].x)),
                static_cast<double>(u * Wide(t[0].y) + v * Wide(t[1].y) + w * Wide(t[2].y)),
                static_cast<double>(u * Wide(t[0].z) + v * Wide(t[1].z) + w * Wide(t[2].z))};
  EXPECT_LE(gap(at, answer.point), rounding);
  EXPECT_LE(gap(query, answer.point), Wide(answer.upper) + rounding);
  EXPECT_GE(gap(query, answer.point), Wide(answer.lower) - rounding);
}

// An exact interval is no wider than the rounding that may have decided it: some 2^-41 of the
// farthest corner's distance in the worst case, and 2^-500 of the model's size, below which squares
// underflow.
void expect_narrow(const BuiltModel& model, const Vec3& query, const ClosestPoint& answer) {
  const ModelInfo& info = model.model().info();
  const auto reach = [](double low, double high, double at) {
    const long double from = at;
    return std::max(std::fabs(low - from), std::fabs(high - from));
  };
  const long double farthest = reach(info.box_lower.x, info.box_upper.x, query.x) +
                               reach(info.box_lower.y, info.box_upper.y, query.y) +
                               reach(info.box_lower.z, info.box_upper.z, query.z);
  const Wide unresolved = ldexp(Wide(1), -498 - model.scale_exponent()) + Wide(0x1p-1060);
  EXPECT_LE(Wide(answer.upper) - Wide(answer.lower), Wide(farthest) * Wide(0x1p-39) + unresolved);
}

// Work that suffices for every query. Records are visited for the distance, for each of six exit
// segments and for the normal. Each triangle may then take several exact signs.
std::uint64_t sufficient_work(const ModelInfo& info) {
  constexpr std::uint64_t kTimes = 8, kSignsOfTriangle = 10;
  return kTimes * (info.nodes + info.blocks +
                   kSignsOfTriangle * octree::WorkUnits::kLargeSign * info.triangles);
}

double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// The normal is the pseudo-normal of the feature or its opposite. It points out of the solid where
// the direction from the nearest point to the query exceeds rounding.
void expect_normal(const BuiltModel& model, const Vec3& query, const ClosestPoint& answer) {
  const Vec3& normal = answer.normal;
  EXPECT_NEAR(dot(normal, normal), 1, 1e-15);
  const ReferenceNormal reference =
      reference_normal(model.triangles(), answer.triangle, answer.barycentric);
  if (reference.certainty < 1e-6) return;
  const double sign = dot(normal, reference.normal) < 0 ? -1 : 1;
  EXPECT_NEAR(normal.x, sign * reference.normal.x, 1e-6);
  EXPECT_NEAR(normal.y, sign * reference.normal.y, 1e-6);
  EXPECT_NEAR(normal.z, sign * reference.normal.z, 1e-6);
  if (answer.side == Side::kUnknown) {
    EXPECT_EQ(sign, 1);
  } else if (answer.side != Side::kOnSurface) {
    const Vec3 way{query.x - answer.point.x, query.y - answer.point.y, query.z - answer.point.z};
    const double length = std::sqrt(dot(way, way));
    const double rounding = 1e-9 * largest_coordinate(model.triangles()[answer.triangle]);
    if (!(length > rounding && std::isfinite(length))) return;
    const double height = dot(way, normal) / length;
    if (answer.side == Side::kOutside) {
      EXPECT_GT(height, -1e-6);
    } else {
      EXPECT_LT(height, 1e-6);
    }
  }
}

void expect_exact(const BuiltModel& model, const Vec3& query, const ClosestPoint& answer) {
  ASSERT_LT(answer.triangle, model.triangles().size());
  const octree::Point point = in_frame(query, model.scale_exponent());
  if (point.cwiseAbs().maxCoeff() <= octree::kMaxQueryCoordinate)
    expect_least(model, query, answer);
  expect_on_triangle(model.triangles()[answer.triangle], query, answer);
  expect_normal(model, query, answer);
}

/// Winding numbers this near one half are not judged.
constexpr long double kNearHalf = 1e-7L;

// The true side, computed in the model frame, where the smallest subnormal numbers are rounded
// away. kUnknown if the winding number is nearly one half.
Side true_side(const BuiltModel& model, const Vec3& query) {
  const auto to_frame = [&](const Vec3& p) {
    const auto scale = [&](double value) { return std::ldexp(value, model.scale_exponent()); };
    return Vec3{scale(p.x), scale(p.y), scale(p.z)};
  };
  Soup triangles = model.triangles();
  for (Corners& triangle : triangles)
    for (Vec3& corner : triangle) corner = to_frame(corner);
  if (model.model().info().watertight()) return exact_side(to_frame(query), triangles);
  const Vec3 point = to_frame(query);
  if (!(std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z)))
    return Side::kOutside;
  const OpenWinding winding = open_winding(point, triangles);
  if (winding.on_surface) return Side::kOnSurface;
  const long double beyond = std::fabs(winding.value) - 0.5L;
  return std::fabs(beyond) < kNearHalf ? Side::kUnknown
         : beyond > 0                  ? Side::kInside
                                       : Side::kOutside;
}

void expect_true_side(const BuiltModel& model, const Vec3& query, Side found) {
  const Side side = true_side(model, query);
  if (side != Side::kUnknown) {
    EXPECT_EQ(found, side);
  }
}

}  // namespace

void expect_same_bits(const ClosestPoint& left, const ClosestPoint& right) {
  EXPECT_EQ(bits_of(left), bits_of(right));
}

void expect_side(BuiltModel& model, const Vec3& query) {
  const Containment found = model.probe().contains(query);
  SCOPED_TRACE(testing::Message() << "side of " << words(query, {}, {}));
  EXPECT_EQ(found.status, found.side == Side::kUnknown ? Status::kDegraded : Status::kExact);
  expect_true_side(model, query, found.side);
}

ClosestPoint expect_sound(BuiltModel& model, const Vec3& query, const QueryOptions& options) {
  const ClosestPoint answer = model.closest_point(query, options);
  SCOPED_TRACE(words(query, options, answer));
  const ClosestPoint again = model.closest_point(query, options);
  const Wide truth = exact_distance(query, model.triangles());
  const bool any_work = options.max_work == std::numeric_limits<std::uint32_t>::max();
  // Beside the last query, an exact answer may take the place of one within an error, and limited
  // work may do more or less.
  if (!any_work)
    expect_interval_holds(again, truth);
  else if (answer.status != Status::kWithinError || again.status != Status::kExact)
    expect_same_bits(answer, again);
  expect_interval_holds(answer, truth);
  const bool unlimited = options.max_error == 0 && options.max_distance == kInfinity && any_work;
  // A winding number of one half leaves the side open, and nothing else.
  const bool only_side_is_open = answer.side == Side::kUnknown && any_work;
  if (unlimited) {
    EXPECT_EQ(answer.status, only_side_is_open ? Status::kDegraded : Status::kExact);
  }
  if (unlimited && only_side_is_open) {
    expect_exact(model, query, answer);
    expect_narrow(model, query, answer);
  }
  switch (answer.status) {
    case Status::kExact:
      expect_exact(model, query, answer);
      if (unlimited) expect_narrow(model, query, answer);
      break;
    case Status::kWithinError:
      EXPECT_LE(answer.upper - answer.lower, options.max_error);
      break;
    case Status::kDegraded:
      if (!only_side_is_open) {
        EXPECT_LT(options.max_work, sufficient_work(model.model().info()));
      }
      break;
    case Status::kBeyondMaxDistance:
      EXPECT_EQ(answer.triangle, kNoTriangle);
      EXPECT_EQ(answer.distance, kInfinity);
      EXPECT_LE(answer.lower, options.max_distance);
      return answer;
    case Status::kBadQuery:
      ADD_FAILURE() << "a query of finite numbers was refused";
  }
  expect_finite(answer);
  if (answer.side != Side::kUnknown || only_side_is_open)
    expect_true_side(model, query, answer.side);
  return answer;
}

}  // namespace planetree::oracle
