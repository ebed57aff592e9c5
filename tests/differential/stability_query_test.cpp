// Queries and limits that break careless arithmetic.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/differential/answer_checks.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/random.h"

namespace planetree::oracle {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kGreatest = std::numeric_limits<double>::max();

// A folded strip of triangles with sides of about 1.
Soup strip(int count) {
  Soup triangles;
  for (int i = 0; i < count; ++i) {
    const double x = i;
    triangles.push_back({Vec3{x, 0, 0.1 * (i % 3)}, Vec3{x + 1, 0, 0.2}, Vec3{x, 1, 0.3}});
  }
  return triangles;
}

// On a corner, an edge or a face the distance is 0, and so is the lower bound.
TEST(StabilityQuery, OnTheSurface) {
  const Soup triangles{{Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}},
                       {Vec3{4, 4, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}}};
  BuiltModel model(triangles);
  for (const Vec3& query :
       {Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{2, 0, 0}, Vec3{2, 2, 0}, Vec3{1, 1, 0}, Vec3{3, 3, 0}}) {
    const ClosestPoint answer = expect_sound(model, query);
    EXPECT_EQ(answer.distance, 0);
    EXPECT_EQ(answer.lower, 0);
  }
  EXPECT_EQ(model.closest_point({4, 0, 0}).feature, Feature::kVertex);
  EXPECT_EQ(model.closest_point({4, 0, 0}).triangle, 0U);
  EXPECT_EQ(model.closest_point({2, 2, 0}).feature, Feature::kEdge);
  EXPECT_EQ(model.closest_point({1, 1, 0}).feature, Feature::kFace);
}

// The smallest step off a corner, in all 26 directions.
TEST(StabilityQuery, OneUlpOff) {
  const Soup triangles{{Vec3{0.1, 0.2, 0.3}, Vec3{1.1, 0.7, -0.3}, Vec3{0.4, 1.2, 0.9}}};
  BuiltModel model(triangles);
  const auto step = [](double value, int way) {
    return way == 0 ? value : std::nextafter(value, way * kInfinity);
  };
  for (const Vec3& corner : triangles[0])
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          expect_sound(model, {step(corner.x, x), step(corner.y, y), step(corner.z, z)});
}

// Exact at any distance, from next to the surface to the end of doubles, for a model of one block
// and for a tree.
TEST(StabilityQuery, AnyDistance) {
  for (const int count : {3, 300}) {
    BuiltModel model(strip(count));
    for (int exponent = -60; exponent < 1023; exponent += 7) {
      const double far = std::ldexp(1.1, exponent);
      expect_sound(model, {far, 0.5, -far});
      expect_sound(model, {0.25, 0.25, far});
    }
    expect_sound(model, {1e300, 1e300, 1e300});
  }
}

// NaN or infinity in any coordinate gives kBadQuery.
TEST(StabilityQuery, NonFiniteCoordinates) {
  BuiltModel model(strip(3));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity})
    for (const Vec3& query : {Vec3{bad, 0, 0}, Vec3{0, bad, 0}, Vec3{0, 0, bad}}) {
      const ClosestPoint answer = model.closest_point(query);
      EXPECT_EQ(answer.status, Status::kBadQuery);
      EXPECT_EQ(answer.lower, 0);
      EXPECT_EQ(answer.distance, kInfinity);
      EXPECT_EQ(answer.upper, kInfinity);
      EXPECT_EQ(answer.triangle, kNoTriangle);
      expect_same_bits(answer, model.closest_point(query));
    }
}

// Bad limits are refused; an infinite max_distance is not one.
TEST(StabilityQuery, BadLimits) {
  BuiltModel model(strip(3));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, -1.0, -kInfinity, kInfinity}) {
    QueryOptions options;
    options.max_error = bad;
    EXPECT_EQ(model.closest_point({0, 0, 0}, options).status, Status::kBadQuery);
    options = {};
    options.max_distance = bad;
    EXPECT_EQ(model.closest_point({0, 0, 0}, options).status,
              bad == kInfinity ? Status::kExact : Status::kBadQuery);
  }
}

// Between opposite ends of the range of doubles the distance is no double; the lower bound must
// still be one.
TEST(StabilityQuery, DistanceBeyondDoubles) {
  const double h = 0.95 * kGreatest;
  const Soup triangles{{Vec3{-h, -h, -h}, Vec3{-h, -h, -h / 2}, Vec3{-h, -h / 2, -h}}};
  BuiltModel model(triangles);
  for (const Vec3& query : {Vec3{h, h, h}, Vec3{h, -h, h}, Vec3{kGreatest, 0, 0}}) {
    const ClosestPoint answer = model.closest_point(query);
    EXPECT_EQ(answer.status, Status::kExact);
    EXPECT_EQ(answer.triangle, 0U);
    EXPECT_TRUE(std::isfinite(answer.lower));
    EXPECT_LE(Wide(answer.lower), exact_distance(query, triangles));
    EXPECT_EQ(answer.upper, kInfinity);
  }
}

// A surface within max_distance is found, however large an error is allowed.
TEST(StabilityQuery, ErrorAndDistanceLimitsTogether) {
  BuiltModel model(translated(strip(100), {0, 9.5, 0}));
  QueryOptions options;
  options.max_error = 1;
  options.max_distance = 10;
  EXPECT_NE(expect_sound(model, {50, 0, 0}, options).status, Status::kBeyondMaxDistance);
  options.max_distance = 9;
  EXPECT_EQ(expect_sound(model, {50, 0, 0}, options).status, Status::kBeyondMaxDistance);
}

// The limit is an ulp below the distance found: "beyond it" must hold exactly, not only after
// rounding.
TEST(StabilityQuery, DistanceLimitAtTheDistance) {
  Random random(3);
  const Soup triangles{{random.in_cube(), random.in_cube(), random.in_cube()}};
  BuiltModel model(triangles);
  for (int i = 0; i < 500; ++i) {
    const Vec3 query = random.in_cube();
    QueryOptions options;
    options.max_distance = model.closest_point(query).distance;
    EXPECT_EQ(expect_sound(model, query, options).status, Status::kExact);
    options.max_distance = std::nextafter(options.max_distance, 0);
    expect_sound(model, query, options);
  }
}

// No work at all still gives bounds.
TEST(StabilityQuery, ZeroWork) {
  BuiltModel model(strip(300));
  QueryOptions options;
  options.max_work = 0;
  for (const Vec3& query : {Vec3{150, 0.5, 0.2}, Vec3{-70, 3, 1}, Vec3{0, 0, 1e12}}) {
    const ClosestPoint answer = expect_sound(model, query, options);
    EXPECT_EQ(answer.status, Status::kDegraded);
    EXPECT_EQ(answer.triangle, kNoTriangle);
  }
}

}  // namespace
}  // namespace planetree::oracle
