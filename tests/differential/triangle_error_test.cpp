// Tries to exceed the error bound of a triangle's distance: with random needles and caps, then by
// steps uphill from the worst of them.

#include "octree/geometry/triangle_distance.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/oracle/brute_force.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/random.h"

namespace planetree::oracle {
namespace {

constexpr int kRandomCases = 1500;
constexpr int kSteps = 1500;

// Twelve coordinates: three corners and the query.
using Case = std::array<double, 12>;

Vec3 vertex(const Case& c, std::size_t k) { return {c[3 * k], c[3 * k + 1], c[3 * k + 2]}; }
octree::Point point(const Case& c, std::size_t k) { return {c[3 * k], c[3 * k + 1], c[3 * k + 2]}; }

// Actual error divided by the error bound.
double share(const Case& c) {
  const auto nearest =
      octree::nearest_on_triangle(point(c, 3), {point(c, 0), point(c, 1), point(c, 2)});
  const Wide truth = exact_square(vertex(c, 3), {vertex(c, 0), vertex(c, 1), vertex(c, 2)}).root();
  return static_cast<double>(abs(truth - Wide(std::sqrt(nearest.value.squared))) /
                             Wide(nearest.value.error));
}

Case random_case(Random& random, const NastyFamily& family) {
  const Soup soup = family.make(random);
  const Corners& triangle = soup[random.below(soup.size())];
  const Vec3 query = nasty_query(random, std::span(&triangle, 1), 1);
  const Vec3& a = triangle[0];
  const Vec3& b = triangle[1];
  const Vec3& c = triangle[2];
  return {a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, query.x, query.y, query.z};
}

Case beside(Random& random, Case at) {
  for (std::size_t changes = 1 + random.below(2); changes > 0; --changes) {
    double& changed = at[random.below(12)];
    changed *= 1 + random.signed_magnitude(-52, -20);
  }
  return at;
}

TEST(TriangleError, NeverExceedsItsBound) {
  double worst = 0;
  for (const NastyFamily& family : nasty_families()) {
    SCOPED_TRACE(std::string(family.name));
    Random random(77);
    Case worst_case{};
    double family_worst = -1;
    const auto consider = [&](const Case& candidate) {
      const double found = share(candidate);
      if (found <= family_worst) return;
      family_worst = found;
      worst_case = candidate;
    };
    const double effort = test_effort();
    for (int i = 0; i < kRandomCases * effort / 10; ++i) consider(random_case(random, family));
    for (int i = 0; i < kSteps * effort; ++i) consider(beside(random, worst_case));
    EXPECT_LE(family_worst, 1);
    worst = std::max(worst, family_worst);
  }
  RecordProperty("worst_share_percent", static_cast<int>(100 * worst));
}

}  // namespace
}  // namespace planetree::oracle
