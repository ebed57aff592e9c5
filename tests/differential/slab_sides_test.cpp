#include <gtest/gtest.h>

#include <cstdint>

#include "tests/oracle/built_model.h"
#include "tests/oracle/closed_models.h"
#include "tests/oracle/random.h"
#include "tests/oracle/winding.h"

// Sides decided by slabs: two planes between which the surface in a mask cell lies.
namespace planetree::oracle {
namespace {

// Share of the points off the surface whose side takes a single page, which is one of the mask,
// among the points whose side the side grid does not give.
double share_decided_by_the_mask(const Soup& soup, double reach) {
  const BuiltModel model(soup, {.max_probes = 2});
  Probe probe = *Probe::create(model.model());
  Random random(7);
  const auto hits = [&] { return model.model().stats().page_hits; };
  unsigned queried = 0, decided = 0;
  for (const Corners& face : model.triangles())
    for (int k = 0; k < 2; ++k) {
      const auto [a, b, c] = face;
      const Vec3 query{(a.x + b.x + c.x) / 3 + reach * random.either_sign(),
                       (a.y + b.y + c.y) / 3 + reach * random.either_sign(),
                       (a.z + b.z + c.z) / 3 + reach * random.either_sign()};
      const std::uint64_t before = hits();
      const Containment found = probe.contains(query);
      EXPECT_EQ(found.status, Status::kExact);
      EXPECT_EQ(found.side, exact_side(query, model.triangles()));
      const std::uint64_t taken = hits() - before;
      queried += taken > 0;
      decided += taken == 1;
    }
  EXPECT_GT(queried, model.triangles().size() / 4);
  return double{1} * decided / queried;
}

TEST(SlabSides, NeedNoPageOfTheTree) {
  const double share = share_decided_by_the_mask(ball(4), 0.1);
  EXPECT_GT(share, 0.5);
}

TEST(SlabSides, AreRightForEveryKindOfSurface) {
  share_decided_by_the_mask(ball(4) + ball(4), 0.05);
  share_decided_by_the_mask(inside_out(ball(4)), 0.05);
  share_decided_by_the_mask(ball(3) + inside_out(ball(4)), 0.2);
}

}  // namespace
}  // namespace planetree::oracle
