// Contacts about nasty points of nasty models, against all triangles. PLANETREE_TEST_EFFORT in the
// environment multiplies the number of queries.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/oracle/built_model.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/queries/contact_oracle.h"

namespace planetree::oracle {
namespace {

// Asks for contacts within the distance of some triangle, and compares them with the oracle.
std::size_t expect_contacts(BuiltModel& model, const Vec3& query, Random& random) {
  const ContactOracle oracle(query, model.triangles());
  std::vector<ClosestPoint> found(1 + random.below(40));
  const ClosestPoint nearest = model.probe().closest_point(query, {.parts = kDistance});
  const double radius = nearest.distance * random.between(1, 1 + random.magnitude(-8, 3));
  const Found set = model.probe().contacts(query, radius, found, {.parts = kDistance});
  EXPECT_TRUE(set.complete || set.count == found.size());
  const auto contacts = std::span(found).first(set.count);
  EXPECT_EQ(oracle.fault(contacts, radius, set.complete), "") << "radius " << radius;
  for (const ClosestPoint& contact : contacts) EXPECT_EQ(contact.status, Status::kExact);
  for (const ClosestPoint& contact : contacts.first(std::min<std::size_t>(set.count, 3))) {
    const Wide truth =
        exact_distance(query, std::span(model.triangles()).subspan(contact.triangle, 1));
    EXPECT_LE(Wide(contact.lower), truth);
    EXPECT_GE(Wide(contact.upper), truth);
  }
  EXPECT_GT(set.count, 0u);
  if (set.count > 0) {
    EXPECT_EQ(found[0].triangle, nearest.triangle);
    EXPECT_EQ(found[0].lower, nearest.lower);
    EXPECT_EQ(found[0].upper, nearest.upper);
    EXPECT_EQ(found[0].feature, nearest.feature);
  }
  return set.count;
}

TEST(Contacts, AreTheLocalMinimaOfTheDistance) {
  const int queries = static_cast<int>(60 * test_effort());
  std::size_t contacts = 0, sets = 0;
  for (const NastyFamily& family : nasty_families()) {
    SCOPED_TRACE(std::string(family.name));
    Random random(41);
    for (int i = 0; i < 3; ++i) {
      BuiltModel model(family.make(random), {4096});
      for (int k = 0; k < queries && !testing::Test::HasFailure(); ++k) {
        const Vec3 query = nasty_query(random, model.triangles(), 1);
        SCOPED_TRACE(testing::Message() << query.x << ' ' << query.y << ' ' << query.z);
        if (std::fabs(query.x) + std::fabs(query.y) + std::fabs(query.z) > 1e6) continue;
        contacts += expect_contacts(model, query, random);
        ++sets;
      }
    }
  }
  EXPECT_GT(sets, 1000u);
  EXPECT_GT(2 * contacts, 3 * sets);
}

}  // namespace
}  // namespace planetree::oracle
