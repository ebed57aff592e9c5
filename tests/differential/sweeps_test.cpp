// Moving balls against all triangles of nasty models, by the distance of their way.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/oracle/nasty_models.h"
#include "tests/oracle/queries/way_oracle.h"
#include "tests/oracle/random.h"

namespace planetree::oracle {
namespace {

constexpr double kNoTime = std::numeric_limits<double>::infinity();

double largest(const Vec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }
double largest(const Soup& triangles) {
  double found = 0;
  for (const Corners& corners : triangles)
    for (const Vec3& corner : corners) found = std::max(found, largest(corner));
  return found;
}

// Motions of all lengths toward, along and away from the surface, by balls of all sizes.
Sweep nasty_sweep(Random& random, const Soup& triangles) {
  constexpr double kRadii[] = {0, 1e-12, 1e-7, 1e-3, 0.05, 0.3, 2};
  const double reach = 1e6 * largest(triangles);
  Sweep sweep;
  do {
    const Corners& some = triangles[random.below(triangles.size())];
    sweep.from = nasty_query(random, triangles, 1);
    switch (random.below(5)) {
      case 0:
        sweep.to = nasty_query(random, triangles, 1);
        break;
      case 1:
        sweep.to = point_on(random, some);
        break;
      case 2:
        sweep.to = some[0];
        break;
      case 3:
        sweep.to = sweep.from + (some[1] - some[0]) * 0.5;
        break;
      default:
        sweep.to = sweep.from + (point_on(random, some) - sweep.from) * 1e-3;
        break;
    }
  } while (!(largest(sweep.from) < reach && largest(sweep.to) < reach));
  sweep.radius = kRadii[random.below(std::size(kRadii))];
  // Often just out of contact, or grazing.
  if (random.below(3) == 0) {
    const double distance = static_cast<double>(extended_distance(sweep.from, triangles));
    sweep.radius = distance * (random.below(2) == 0 ? 1 : 0.999);
  }
  return sweep;
}

void expect_contact(const Soup& triangles, const Sweep& sweep, const FirstContact& answer) {
  EXPECT_EQ(answer.status, Status::kExact);
  EXPECT_EQ(answer.free, answer.t == kNoTime);
  EXPECT_LE(answer.t_lower, answer.t);
  EXPECT_LE(answer.t, answer.t_upper);
  const double free_until = std::min(answer.t_lower, 1.0);
  bool touched = answer.t_upper == kNoTime;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (free_until > 0) {
      EXPECT_GE(compare_way(sweep, free_until, triangles[i]), 0) << "tunnel through " << i;
    }
    touched = touched || compare_way(sweep, std::min(answer.t_upper, 1.0), triangles[i]) <= 0;
  }
  EXPECT_TRUE(touched);
  if (answer.free) {
    EXPECT_EQ(answer.at.triangle, kNoTriangle);
  } else {
    ASSERT_LT(answer.at.triangle, triangles.size());
    if (answer.t > 0) {
      const double size = largest(triangles) + largest(sweep.from) + largest(sweep.to);
      EXPECT_NEAR(answer.at.distance, sweep.radius, 1e-6 * (size + sweep.radius));
    } else {
      EXPECT_LE(answer.at.distance,
                sweep.radius * (1 + 1e-12) +
                    1e-12 * (largest(triangles) + largest(sweep.from) + largest(sweep.to)));
    }
  }
}

TEST(Sweeps, StopAtTheFirstContact) {
  std::size_t contacts = 0, free = 0, open = 0;
  for (const NastyFamily& family : nasty_families()) {
    SCOPED_TRACE(std::string(family.name));
    Random random(43);
    for (int i = 0; i < 3 * test_effort(); ++i) {
      BuiltModel model(family.make(random), {4096});
      for (int k = 0; k < 40 && !testing::Test::HasFailure(); ++k) {
        const Sweep sweep = nasty_sweep(random, model.triangles());
        SCOPED_TRACE(testing::Message()
                     << "model " << i << " sweep " << k << " radius " << sweep.radius);
        const FirstContact answer = model.probe().first_contact(sweep);
        (answer.free ? free : contacts) += 1;
        open += !answer.free && answer.t_upper == kNoTime;
        if (sweep.radius > 0) expect_contact(model.triangles(), sweep, answer);
      }
    }
  }
  EXPECT_GT(contacts, 1000u);
  EXPECT_GT(free, 150u);
  EXPECT_LT(open, contacts / 5);
}

// A small ball that moves almost along an edge, closer than rounding lets the direction to the edge
// be known, is free if it stays beside it.
TEST(Sweeps, PassAlongAnEdge) {
  Random random(44);
  for (int i = 0; i < 40; ++i) {
    const Corners triangle{random.in_some_cube(0, 0), random.in_some_cube(0, 0),
                           random.in_some_cube(0, 0)};
    const Vec3 edge = triangle[1] - triangle[0], other = triangle[2] - triangle[0];
    const double squared = edge.x * edge.x + edge.y * edge.y + edge.z * edge.z;
    const double share = (edge.x * other.x + edge.y * other.y + edge.z * other.z) / squared;
    const Vec3 away = edge * share - other;
    const double height = std::ldexp(1e-9, static_cast<int>(random.below(6)));
    const Sweep sweep{triangle[0] + edge * 0.1 + away * height,
                      triangle[1] - edge * 0.1 + away * (2 * height), 1e-12};
    BuiltModel model(Soup{triangle}, {4096});
    const FirstContact answer = model.probe().first_contact(sweep);
    SCOPED_TRACE(i);
    EXPECT_GE(compare_way(sweep, 1, triangle), 0);
    EXPECT_TRUE(answer.free) << answer.t;
  }
}

}  // namespace
}  // namespace planetree::oracle
