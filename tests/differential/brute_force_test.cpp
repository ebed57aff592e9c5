// The oracles agree: exact integers, long double and CGAL.

#include "tests/oracle/brute_force.h"

#include <gtest/gtest.h>

#include "tests/oracle/cgal_oracle.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/random.h"

namespace planetree::oracle {
namespace {

const Corners kTriangle{Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 3, 0}};

// Known answers in each of the seven regions.
TEST(BruteForce, GivesKnownDistancesInEveryRegion) {
  struct Known {
    Vec3 query;
    double distance;
  };
  const Known known[] = {{{-3, -4, 0}, 5}, {{7, 0, 4}, 5},     {{0, 6, 4}, 5},   {{2, -3, 4}, 5},
                         {{-3, 1, 4}, 5},  {{1, 1, 2}, 2},     {{1, 1, 0}, 0},   {{0, 0, 0}, 0},
                         {{2, 1.5, 0}, 0}, {{3.2, 3.1, 0}, 2}, {{2, 1.5, -7}, 7}};
  for (const auto& [query, distance] : known) {
    EXPECT_NEAR(static_cast<double>(exact_square(query, kTriangle).root()), distance, 1e-15);
    EXPECT_NEAR(static_cast<double>(extended_distance(query, kTriangle)), distance, 1e-15);
  }
}

// No double is too large or too small for the integers.
TEST(BruteForce, IsExactAtAnyScale) {
  for (const double size : {0x1p-1074, 0x1p-600, 1.0, 0x1p500, 0x1p1020}) {
    const Corners triangle{Vec3{0, 0, 0}, Vec3{4 * size, 0, 0}, Vec3{0, 3 * size, 0}};
    const Wide distance = exact_square({-3 * size, -4 * size, 0}, triangle).root();
    EXPECT_LT(abs(distance - 5 * Wide(size)), Wide(size) * Wide(1e-140));
  }
}

// Skipping far triangles misses none. The models include segments and points.
TEST(BruteForce, AgreesWithEvaluatingEveryTriangle) {
  for (const NastyFamily& family : nasty_families()) {
    Random random(8);
    const Soup triangles = family.make(random);
    for (int i = 0; i < 10; ++i) {
      const Vec3 query = nasty_query(random, triangles, 1);
      Wide least = exact_square(query, triangles[0]).root();
      for (const Corners& triangle : triangles)
        least = std::min(least, exact_square(query, triangle).root());
      EXPECT_EQ(exact_distance(query, triangles), least) << family.name;
    }
  }
}

TEST(BruteForce, AgreesWithCgal) {
  Random random(9);
  Soup triangles;
  for (int i = 0; i < 500; ++i) {
    const Vec3 at = random.in_cube();
    triangles.push_back({at, at + random.in_cube() * 0.1, at + random.in_cube() * 0.1});
  }
  triangles.push_back({Vec3{0, 0, 0}, Vec3{1, 1, 1}, Vec3{1, 1, 1}});
  const CgalOracle cgal(triangles);
  EXPECT_GE(cgal.thin_count(), 1U);
  for (int i = 0; i < 500; ++i) {
    const Vec3 query = random.in_cube() * 1.5;
    const long double distance = extended_distance(query, triangles);
    EXPECT_NEAR(static_cast<double>(cgal.distance(query) - distance), 0, 1e-14);
    EXPECT_NEAR(static_cast<double>(exact_distance(query, triangles) - Wide(distance)), 0, 1e-14);
  }
}

}  // namespace
}  // namespace planetree::oracle
