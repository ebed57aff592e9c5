// Rays against all triangles of nasty models, in rationals.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "tests/oracle/nasty_models.h"
#include "tests/oracle/queries/way_oracle.h"
#include "tests/oracle/random.h"

namespace planetree::oracle {

void PrintTo(const NastyFamily& family, std::ostream* out) { *out << family.name; }

namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

bool is_moderate(const Vec3& v) { return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z) < 1e60; }

// Rays between places where arithmetic is critical, along axes, within faces and from the surface.
Ray nasty_ray(Random& random, const Soup& triangles) {
  Ray ray;
  do {
    ray.origin = nasty_query(random, triangles, 1);
    const Corners& some = triangles[random.below(triangles.size())];
    switch (random.below(6)) {
      case 0:
        ray.direction = nasty_query(random, triangles, 1) - ray.origin;
        break;
      case 1:
        ray.direction = some[0] - ray.origin;
        break;
      case 2:
        ray.direction = (some[1] + some[2]) * 0.5 - ray.origin;
        break;
      case 3:
        ray.direction = some[1] - some[0];
        break;
      case 4:
        ray.direction = {random.below(2) ? 1.0 : 0.0, random.below(2) ? -1.0 : 0.0, 0.25};
        break;
      default:
        ray.direction = point_on(random, some) - ray.origin;
        break;
    }
    if (random.below(4) == 0) ray.direction = ray.direction * 1e-9;
  } while (!is_moderate(ray.origin) || !is_moderate(ray.direction) ||
           (ray.direction.x == 0 && ray.direction.y == 0 && ray.direction.z == 0));
  if (random.below(3) == 0) ray.t_max = 1;
  if (random.below(5) == 0) ray.t_min = 0.25;
  return ray;
}

Vec3 as_given(const Ray& ray) { return ray.direction; }

void expect_hit(const Ray& ray, const LineMeeting& truth, const RayHit& hit) {
  ASSERT_NE(truth.meeting, Meeting::kMisses);
  ASSERT_TRUE(truth.has_t);
  EXPECT_LE(Rational(hit.t_lower), truth.t);
  EXPECT_GE(Rational(hit.t_upper), truth.t);
  EXPECT_LE(hit.t_lower, hit.t);
  EXPECT_LE(hit.t, hit.t_upper);
  EXPECT_GE(hit.t, ray.t_min);
  EXPECT_LE(hit.t, ray.t_max);
  EXPECT_EQ(hit.entering, truth.entering);
}

// The least step of `t` that the library resolves: 2^-1020 in the model frame.
Rational least_step(const BuiltModel& model, const Ray& ray) {
  const auto& [x, y, z] = ray.direction;
  const double largest = std::max({std::fabs(x), std::fabs(y), std::fabs(z)});
  return Rational(std::ldexp(1.0, -1020 - model.scale_exponent())) / Rational(largest);
}

// Whether a triangle that the line passes through must be among the hits: not at an end of the
// range, where `t` is rounded.
bool is_within(const Ray& ray, const Rational& t, const Rational& least_step) {
  const Rational margin = abs(t) * Rational(1e-14) + least_step;
  return (ray.t_min == 0 ? t >= 0 : t > Rational(ray.t_min) + margin) &&
         (ray.t_max == kEndless || t < Rational(ray.t_max) - margin);
}

// A point as the model frame has it: the smallest subnormal numbers are rounded there.
Vec3 as_in_frame(const BuiltModel& model, const Vec3& point) {
  const auto rounded = [exponent = model.scale_exponent()](double value) {
    return std::ldexp(std::ldexp(value, exponent), -exponent);
  };
  return {rounded(point.x), rounded(point.y), rounded(point.z)};
}

void expect_hits(BuiltModel& model, const Ray& ray, std::size_t& hits) {
  std::vector<RayHit> found(model.triangles().size());
  const Found set = model.probe().all_hits(ray, found);
  ASSERT_TRUE(set.complete);
  hits += set.count;
  std::map<std::uint64_t, const RayHit*> by_triangle;
  for (std::size_t i = 0; i < set.count; ++i) {
    EXPECT_EQ(found[i].status, Status::kExact);
    EXPECT_TRUE(by_triangle.emplace(found[i].triangle, &found[i]).second) << "doubled";
    if (i > 0) {
      EXPECT_LE(found[i - 1].t, found[i].t);
    }
  }
  const Vec3 origin = as_in_frame(model, ray.origin);
  const Rational step = least_step(model, ray);
  const auto direction = exact_difference(as_given(ray), {0, 0, 0});
  for (std::size_t i = 0; i < model.triangles().size(); ++i) {
    const LineMeeting truth = meet(origin, direction, model.triangles()[i]);
    const auto hit = by_triangle.find(i);
    if (hit != by_triangle.end()) {
      expect_hit(ray, truth, *hit->second);
    } else if (truth.meeting == Meeting::kPasses) {
      EXPECT_FALSE(is_within(ray, truth.t, step)) << "missed " << i << ' ' << double(truth.t);
    }
  }
  const RayHit first = model.probe().first_hit(ray);
  EXPECT_EQ(first.status, Status::kExact);
  if (set.count == 0) {
    EXPECT_EQ(first.t, kEndless);
    EXPECT_EQ(first.t_lower, kEndless);
    EXPECT_EQ(first.triangle, kNoTriangle);
  } else {
    EXPECT_EQ(first.t, found[0].t);
    EXPECT_EQ(first.triangle, found[0].triangle);
    EXPECT_LE(first.t_lower, found[0].t_lower);
    EXPECT_LE(first.t_upper, found[0].t_upper);
  }
}

class Rays : public testing::TestWithParam<NastyFamily> {};

TEST_P(Rays, HitWhatTheyPassThrough) {
  std::size_t hits = 0;
  Random random(41);
  for (int i = 0; i < 2 * test_effort(); ++i) {
    BuiltModel model(GetParam().make(random), {4096});
    for (int k = 0; k < 40 && !testing::Test::HasFailure(); ++k) {
      const Ray ray = nasty_ray(random, model.triangles());
      SCOPED_TRACE(testing::Message() << "model " << i << " ray " << k);
      expect_hits(model, ray, hits);
    }
  }
  EXPECT_GT(hits, 10u);
}

std::string family_name(const testing::TestParamInfo<NastyFamily>& info) {
  std::string name(info.param.name);
  std::erase_if(name, [](unsigned char c) { return std::isalnum(c) == 0; });
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, Rays, testing::ValuesIn(nasty_families()), family_name);

}  // namespace
}  // namespace planetree::oracle
